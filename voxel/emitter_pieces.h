#pragma once
#include <vector>

#include "core/light.h"
#include "voxel/grid.h"

namespace volgi {

/// Emissive triangles cut along the grid's columns (of the axis nearest to their normal), so that what a small or
/// oblique emitter sends into the volume is exact: the flux of a piece is pi · L_e · area, L_e the mean of a textured
/// emission over four points of the piece. Double-sided materials give two pieces. Sum over all pieces: pi · ∫ L_e dA,
/// to rounding without textures. Cost: one polygon clip for each column that a triangle's box touches.
std::vector<FluxSample> emitter_pieces(const Scene& scene, const Grid& grid);

}  // namespace volgi
