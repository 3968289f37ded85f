#pragma once
#include <vector>

#include "core/visibility/embree_scene.h"
#include "propagation/passage_face.h"
#include "voxel/voxel_grid.h"

namespace volgi {

/// Faces in which passages narrower than eight cells join two rooms (voxel/rooms.h), by cell. Around each passage the
/// same paths of diffuse light go from surface to surface and from side to side; the factor makes as many of them get
/// from one room into the other (docs/theory.md#narrow-passages). Depends on the scene, not on its light. No result
/// depends on the number of threads. Cost: some visits of every cell; where there is more than one room, 2^15 paths for
/// each passage. Grids of more than 2^23 cells have none. No twin: the GPU's volume takes gaps as its cells show them.
/// @param voxels  of the scene that `embree` holds, all of them (no part of several ranks).
std::vector<PassageFace> narrow_passages(const VoxelGrid& voxels, const EmbreeScene& embree);

}  // namespace volgi
