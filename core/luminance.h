#pragma once
#include <glm/glm.hpp>

namespace volgi {

/// Rec. 709 luminance. Twin: shaders/shared/luminance.glsl.
inline double luminance(glm::dvec3 c) { return glm::dot(c, glm::dvec3(0.2126, 0.7152, 0.0722)); }

}  // namespace volgi
