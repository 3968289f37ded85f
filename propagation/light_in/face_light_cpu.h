#pragma once
#include <vector>

#include "core/light.h"
#include "core/scene.h"
#include "voxel/side_halo.h"
#include "voxel/voxel_grid.h"

namespace volgi {

/// What surfaces lit by the scene's punctual lights reflect, as the volume has them: the rays of light_flux(), but met
/// by the grid's own faces (voxel/grid_faces.h) in place of triangles, so that nobody needs a tree of all triangles.
/// What a ray meets is a side's: a point of its surface, its normal and its albedo. Shadows and edges are as wide as
/// cells; where a lamp is smaller than a cell, or behind what is, its light may be lost (docs/theory.md#light-in).
/// Cost: as light_flux(), a step for each cell that a ray crosses near surfaces.
/// @param texels_on_edge  as light_flux().
std::vector<FluxSample> face_light(const Scene& scene, const VoxelGrid& voxels, int texels_on_edge);

/// All ranks: their shares of the rays, each of which is answered for by the rank that has the side; numbers are in the
/// order of those of all ranks together.
std::vector<NumberedFluxSample> face_light(const Scene& scene, const VoxelGrid& voxels, const RanksOfVolume& ranks,
                                           int texels_on_edge);

}  // namespace volgi
