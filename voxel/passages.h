#pragma once
#include <optional>
#include <span>
#include <vector>

#include "voxel/voxel_grid.h"

namespace volgi {

/// A point of a surface, and where that looks.
struct LitPoint {
  glm::vec3 position, normal;
};

/// Cells along the longest axis, `cells` or up to 8/3 of them, in which what air joins stays joined: light goes round
/// an open door, but not where cells are wider than the gap. Places are joined through faces that let half of the light
/// pass. They are found in cells half as large as those asked for, and then in 4, 3 and 2 times larger ones: passages
/// that are open there are some two cells wide in the grid that is returned. Places smaller than 1/50 of the scene, and
/// the inside of bodies, do not count; nor, where `lit` has points, do those with less than a hundredth of them.
/// @param box  as make_grid. @param most_cells  of the grid in all; looking takes up to twice as many.
/// Cost: a scene of one place one voxelization of 1/8 of the cells; of several, four more of up to twice as many.
/// @throws Error as make_grid.
int cells_that_keep_passages(const Scene& scene, int cells, size_t most_cells, std::span<const LitPoint> lit = {},
                             const std::optional<GridBox>& box = {});

/// Number of its place for each cell of a grid, x fastest; -1: inside of a body, all of whose sides are backs.
std::vector<int> places_of(const VoxelGrid& voxels);

}  // namespace volgi
