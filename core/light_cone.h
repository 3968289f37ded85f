#pragma once
#include <cmath>
#include <glm/glm.hpp>

#include "core/scene.h"

namespace volgi {

/// 1 - cos of half the cone that a light fills: 2 for a point light. Without the cancellation.
inline double cone_height(const Light& light) {
  if (light.type == Light::Type::point) return 2.0;
  const double s = std::sin(0.5 * double(light.outer_cone_rad));
  return 2.0 * s * s;
}

/// The shortest turn that takes -Y to `d` (unit): (0, -1, 0) x d = (-z, 0, x) is its axis. Straight up all turns are as
/// short; half a turn about X is taken.
inline glm::mat3 world_from_axis(glm::dvec3 d) {
  const double across = d.x * d.x + d.z * d.z;
  if (d.y > 0.0 && across < 1e-30) return glm::mat3(1, 0, 0, 0, -1, 0, 0, 0, -1);
  const double k = d.y > 0.0 ? (1.0 + d.y) / across : 1.0 / (1.0 - d.y);  // 1 / (1 - y), without cancellation
  return glm::mat3(glm::dmat3(1.0 - k * d.x * d.x, d.x, -k * d.x * d.z,   // columns
                              -d.x, -d.y, -d.z,                           //
                              -k * d.x * d.z, d.z, 1.0 - k * d.z * d.z));
}

}  // namespace volgi
