#pragma once
#include <cstddef>

#include "voxel/side_halo.h"
#include "voxel/voxel_grid.h"

namespace volgi {

/// Surfaces that reflect all light in a place that none leaves, such as the inside of a lamp's white body, have no
/// finite answer as soon as a light is in it, and make the equations of bounces singular for the whole volume. There
/// sides get the albedo MAX_POCKET_ALBEDO, band by band; all others keep theirs. A cell is in such a place unless it is
/// joined, through faces that do not stop everything, to the outside of the grid or to a cell with a side of less than
/// WHITE_ALBEDO. @return cells in such places. Cost: a look at every cell; memory: half a KiB a block of
/// 8^3 cells with sides, 16 bytes a block. Twin: WhitePocketsGl.
size_t bound_white_pockets(VoxelGrid& voxels, const RanksOfVolume* ranks = nullptr);

/// Whether a scene with this largest albedo can have such places.
bool may_have_white_pockets(float largest_albedo);

}  // namespace volgi
