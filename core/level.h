#pragma once
#include <glm/glm.hpp>

namespace volgi {

/// Mean over red, green and blue.
inline float level(glm::vec3 v) { return (v.x + v.y + v.z) / 3.0f; }

}  // namespace volgi
