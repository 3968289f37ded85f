#pragma once
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "propagation/light_in/gather_rows_cpu.h"
#include "voxel/voxel_grid.h"

namespace volgi {

/// What rays have gathered on sides, without their noise: where light comes from little of what a surface sees, as
/// through a gap into a dark room, a few rays do not tell places apart, while the volume knows how its light is spread
/// but less well how much there is. So of each side
///   E = w_0 E_rays + (1 - w_0) E_volume (w_1 g_1 + (1 - w_1) (w_2 g_2 + ...)),   w_j = t^2 / (t^2 + s_j^2),
/// with E_rays the mean over 3^3 cells, g_j the ratio of what rays and what the volume have on the sides of cells of
/// 4^3, 8^3 ... 32^3 that look the same way, trilinear between them, s_j the relative noise of each, and t what the
/// volume's own distribution errs by (5 %).
/// @param gathered    by side; those without rays have no say, and stay as the volume has them.
/// @param irradiance  by side, the volume's [W m^-2]. @return the same with w = 1.
std::vector<glm::vec4> steadied(const VoxelGrid& voxels, std::span<const Gathered> gathered,
                                std::span<const glm::vec4> irradiance);

}  // namespace volgi
