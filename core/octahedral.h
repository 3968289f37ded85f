#pragma once
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <glm/packing.hpp>

namespace volgi {

/// Unit vector from two numbers of [-1, 1]. Twin: shaders/shared/octahedral.glsl.
inline glm::vec3 octahedral_decode(glm::vec2 v) {
  const float z = 1.0f - std::abs(v.x) - std::abs(v.y);
  if (z >= 0.0f) return glm::normalize(glm::vec3(v, z));
  const glm::vec2 folded{(1.0f - std::abs(v.y)) * (v.x >= 0.0f ? 1.0f : -1.0f),
                         (1.0f - std::abs(v.x)) * (v.y >= 0.0f ? 1.0f : -1.0f)};
  return glm::normalize(glm::vec3(folded, z));
}
inline glm::vec3 octahedral_decode(std::uint32_t packed) { return octahedral_decode(glm::unpackSnorm2x16(packed)); }

}  // namespace volgi
