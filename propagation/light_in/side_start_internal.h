#pragma once
#include <glm/glm.hpp>

#include "core/visibility/embree_scene.h"
#include "voxel/voxel_grid.h"

namespace volgi {

/// Where rays of a side start.
struct SideStart {
  glm::vec3 position;  // on the surface
  glm::vec3 origin;    // of rays: beside the surface, where the cell is
  TriangleIndex from;
};

/// A point for all of a side's surface: on the line through the middle of what the cell's other sides leave of the
/// cell. (Through the cell's centre, a wall would be asked for its light on the very floor that passes it there:
/// thin_wall in 32 cells lost 2 % of its energy.) Where an edge is near, on one of the eight lines around the centre
/// that coverage is counted on (docs/theory.md#voxelization) and that steps in their plane reach. Where that meets
/// nothing (surfaces that end between the lines once they are rounded), rays start in the cell's centre.
SideStart start_of_side(const VoxelGrid& voxels, const EmbreeScene& embree, const shared::Side& side);

}  // namespace volgi
