#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>

#include "voxel/voxel_grid.h"

namespace volgi {

/// Which of the eight cells around a place see a point of a surface: a cell's centre may lie behind a sheet that the
/// point is in front of. A cell does not see the point if it is behind the point's own plane, or if one of its opaque
/// sides hides it (shared::side_hides). A cell beyond both walls of a corner has no side there and does not know; so
/// the cells that do, which have a side towards another of the eight with the point in front of it, come first, and
/// only what open faces join to the first of them is on the point's side. Twin: shaders/voxel/seeing_cells.glsl.
struct SeeingCells {
  glm::ivec3 low;       // of the eight; bits of a corner's number are its steps along x, y, z
  int nearest = -1;     // corner on the point's side, nearest to the place; it may be outside of the grid; -1: none is
  unsigned joined = 0;  // bits of the corners on the point's side

  glm::ivec3 cell(int corner) const { return low + glm::ivec3(corner & 1, (corner >> 1) & 1, corner >> 2); }
};

/// @param around  a place in front of the surface, and the point a little in front of it, in cell units.
SeeingCells seeing_cells(const VoxelGrid& voxels, glm::vec3 around, glm::vec3 point, glm::vec3 normal);

/// The cell that sees a point of a surface best, or the one that it lies in.
glm::ivec3 seeing_cell(const VoxelGrid& voxels, glm::vec3 point, glm::vec3 normal);

/// Whether one of a cell's sides hides the point (cell units) of a surface of that normal from it (shared::side_hides).
bool hidden_from_cell(const VoxelGrid& voxels, glm::ivec3 cell, glm::vec3 point, glm::vec3 normal);

/// Whether faces are open all the way from a cell to another one near it, along the axis with the longest way left at
/// each step. False where the first is outside of the grid. Twin: shaders/voxel/open_way.glsl.
bool open_way(const VoxelGrid& voxels, glm::ivec3 from, glm::ivec3 to);

}  // namespace volgi
