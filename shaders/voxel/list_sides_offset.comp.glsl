#version 450 core
// Adds the offset of its group (gl::Scan) to every cell's first side. Where the list has no room for all, the last cells have none,
// but what is closed stays closed: whatever reads the list stays inside.
#include "shared/global_index.shared.h"
#include "voxel/grid_block.glsl"
#include "voxel/groups.shared.h"

layout(local_size_x = VOXEL_GROUP) in;
layout(std430, binding = WANTED_SLOT) readonly buffer Wanted { uint wanted[4]; };
layout(std430, binding = CELL_SIDES_SLOT) buffer CellSides { uvec2 cell_sides[]; };
layout(std430, binding = GROUP_TOTALS_SLOT) readonly buffer GroupTotals { uint group_totals[]; };
layout(std430, binding = SIDE_COUNT_SLOT) writeonly buffer SideCount { uint side_count; };
uniform uint capacity;

void main() {
  uint cell = global_index();
  if (cell == 0u && wanted[3] <= capacity) side_count = wanted[3];
  if (cell >= uint(grid.cells.x * grid.cells.y * grid.cells.z)) return;
  uvec2 own = cell_sides[cell];
  uint first = own.x + group_totals[group_index()];
  uint end = first + bitCount(own.y & 63u);
  cell_sides[cell] = end <= capacity ? uvec2(first, own.y) : uvec2(0u, own.y & ~63u);
  if (first <= capacity && end > capacity) side_count = first;  // one cell only
}
