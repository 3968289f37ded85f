#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>

namespace volgi {

/// Even over the sphere: an additive recurrence (Roberts 2018).
inline glm::vec3 even_direction(std::uint32_t k) {
  const float u = float(3242174889u * k >> 8) * 0x1p-24f, v = float(2447445414u * k >> 8) * 0x1p-24f;
  const float y = 1.0f - 2.0f * u, across = std::sqrt(std::max(0.0f, 1.0f - y * y));
  return {across * std::cos(glm::two_pi<float>() * v), y, across * std::sin(glm::two_pi<float>() * v)};
}

}  // namespace volgi
