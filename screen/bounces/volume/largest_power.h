#pragma once
#include "core/scene.h"

namespace volgi::screen {

/// What no light sends more than into its map [W], largest band, up to what few texels get wrong: sums in fixed point
/// are shares of it (propagation/side_flux_gl.h).
float largest_power(const Light& light, glm::vec3 bounds_min, glm::vec3 bounds_max);

/// The same of all lights and the sky together.
float largest_reflected_power(const Scene& scene);
/// Of emissive surfaces: four times theirs, as samples of textures are no exact sum.
float largest_emitted_power(const Scene& scene);

}  // namespace volgi::screen
