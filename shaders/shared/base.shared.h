// Lets one file be read by C++ (GLM) and by GLSL. Every *.shared.h includes this first. C++ names live in
// volgi::shared.
#ifndef VOLGI_BASE_SHARED_H
#define VOLGI_BASE_SHARED_H
#ifdef __cplusplus
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
namespace volgi::shared {
using glm::abs, glm::clamp, glm::cross, glm::dot, glm::floor, glm::length, glm::max, glm::min, glm::normalize,
    glm::sqrt;
using glm::ivec2, glm::ivec3, glm::ivec4, glm::mat4, glm::uvec2, glm::uvec3, glm::uvec4, glm::vec2, glm::vec3,
    glm::vec4;
using uint = std::uint32_t;
}  // namespace volgi::shared
#define SHARED_FUNCTION inline
#define SHARED_BEGIN namespace volgi::shared {
#define SHARED_END }
#else
#define SHARED_FUNCTION
#define SHARED_BEGIN
#define SHARED_END
#endif
#endif
