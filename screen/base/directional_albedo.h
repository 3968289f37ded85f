#pragma once
#include <glm/glm.hpp>
#include <vector>

namespace volgi::screen {

inline constexpr int DIRECTIONAL_ALBEDO_SIZE = 32;

/// What a mirror of facets (glTF 2.0, appendix B) reflects of even light to a viewer: at_0 times x plus at_90 times y
/// of shared::Reflectance. Rows by perceptual roughness, columns by the cosine to the viewer, at (i + 1/2) / SIZE.
/// phong: what a Phong lobe of shared::phong_exponent() does, by the mean of 64 x 64 directions; y is 0. Numbers of a
/// sum over visible normals (Heitz 2018), 512 each: within 0.003. Made once, in some 50 ms.
const std::vector<glm::vec2>& directional_albedo(bool phong = false);

}  // namespace volgi::screen
