#pragma once
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>

namespace volgi {

/// Unit, by the cosine about the normal: a point of the unit square on the disk below the hemisphere.
inline glm::vec3 cosine_direction(glm::vec3 normal, glm::vec2 uv) {
  const glm::vec3 other = std::abs(normal.x) < 0.7f ? glm::vec3(1.0f, 0.0f, 0.0f) : glm::vec3(0.0f, 1.0f, 0.0f);
  const glm::vec3 right = glm::normalize(glm::cross(normal, other)), up = glm::cross(normal, right);
  const float radius = std::sqrt(uv.x), angle = glm::two_pi<float>() * uv.y;
  return glm::normalize(radius * (std::cos(angle) * right + std::sin(angle) * up) + std::sqrt(1.0f - uv.x) * normal);
}

/// Point n of an additive recurrence in the unit square (Roberts 2018: powers of 1/1.3247..., in units of 2^-32).
inline glm::vec2 recurrence_in_square(std::uint32_t n) {
  return {float(3242174889u * n >> 8) * 0x1p-24f, float(2447445414u * n >> 8) * 0x1p-24f};
}

}  // namespace volgi
