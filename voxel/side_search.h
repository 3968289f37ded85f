#pragma once
#include <glm/glm.hpp>

#include "voxel/voxel_grid.h"

namespace volgi {

/// Which sides stand for a point of a surface: at most one for each axis, with the weights |n_x| : |n_y| : |n_z| over
/// those found (they sum to 1, or to 0 where no side faces alike). Twin of shaders/voxel/find_side.glsl.
struct SidesOfPoint {
  glm::ivec3 sides{-1};
  glm::vec3 weights{0.0f};
};

/// @param front  1 or 0: only sides that show a triangle's front or back, and that do not hide the point behind another
///               surface; -1: any.
SidesOfPoint sides_of_point(const VoxelGrid& voxels, glm::vec3 world_position, glm::vec3 normal, int front);

}  // namespace volgi
