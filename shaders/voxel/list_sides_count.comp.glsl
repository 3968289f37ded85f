#version 450 core
// For every cell: which faces have sides, and the number of sides of the cells before it in its group (a scan).
#include "shared/global_index.shared.h"
#include "voxel/grid_block.glsl"
#include "voxel/groups.shared.h"
#define SCAN_GROUP uint(VOXEL_GROUP)
#include "shared/scan.glsl"

layout(local_size_x = VOXEL_GROUP) in;
layout(std430, binding = LIST_COVERAGE_SLOT) readonly buffer Coverage { float at[]; } coverage[3];
layout(std430, binding = CELL_SIDES_SLOT) writeonly buffer CellSides { uvec2 cell_sides[]; };
layout(std430, binding = GROUP_TOTALS_SLOT) buffer GroupTotals { uint group_totals[]; };

float face_coverage(int axis, int face) {
  return axis == 0 ? coverage[0].at[face] : axis == 1 ? coverage[1].at[face] : coverage[2].at[face];
}

void main() {
  int cell = int(global_index());
  bool inside = cell < grid.cells.x * grid.cells.y * grid.cells.z;
  uint bits = 0u;
  if (inside) {
    ivec3 c = cell_coord(grid, cell);
    for (int face = 0; face < 6; ++face) {
      ivec3 face_cell = c;
      face_cell[face >> 1] += face & 1;
      float covered = face_coverage(face >> 1, face_index(grid, face >> 1, face_cell));
      if (covered > 0.0) bits |= 1u << face;
      if (covered == 1.0) bits |= 256u << face;
    }
  }
  uint count = bitCount(bits & 63u);
  uint before = sum_before(count);
  if (inside) cell_sides[cell] = uvec2(before, bits);
  if (gl_LocalInvocationIndex == SCAN_GROUP - 1u && group_index() < uint(group_totals.length()))
    group_totals[group_index()] = before + count;
}
