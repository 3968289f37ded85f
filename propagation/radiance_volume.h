#pragma once
#include <vector>

#include "voxel/grid.h"
#include "voxel/openvdb_fwd.h"

namespace volgi {

/// Radiance in free space as spherical harmonics per cell [W m^-2 sr^-1], rgb in x, y, z; real, orthonormal, in the
/// order 00, 1-1 (y), 10 (z), 11 (x), then 2-2, 2-1, 20, 21, 22 (docs/conventions.md#spherical-harmonics). The
/// direction is the one that light travels. Index space is cell coordinates, the transform that of world_from_index.
struct RadianceVolume {
  std::vector<vdb::Vec3SGridPtr> sh;  // 4 or 9
};

/// Names of the coefficients' grids in files: sh_00, sh_1m1, sh_10, sh_11, sh_2m2, sh_2m1, sh_20, sh_21, sh_22.
const char* sh_grid_name(int coefficient);
/// Fluence [W m^-2] = sqrt(4 pi) sh_00.
vdb::Vec3SGridPtr fluence(const RadianceVolume& radiance);

}  // namespace volgi
