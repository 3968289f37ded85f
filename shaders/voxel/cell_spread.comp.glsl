#version 450 core
// Cells pass their marks, bits each, to those that follow them along an axis, both ways, up to faces that stop
// everything. One thread a column.
#include "shared/global_index.shared.h"
#include "shared/group_sizes.shared.h"
#include "voxel/cell_sides.glsl"
#include "voxel/grid_block.glsl"

layout(local_size_x = LINEAR_GROUP) in;
layout(std430, binding = CELL_MARKS_SLOT) buffer Marks { uint marks[]; };
uniform int axis;

void main() {
  int b = axis_b(axis), c = axis_c(axis);
  int column = int(global_index());
  if (column >= grid.cells[b] * grid.cells[c]) return;
  ivec3 cell = ivec3(0);
  cell[b] = column % grid.cells[b];
  cell[c] = column / grid.cells[b];
  for (int way = 1; way >= -1; way -= 2) {
    uint passed = 0u;
    for (int i = 0; i < grid.cells[axis]; ++i) {
      cell[axis] = way > 0 ? i : grid.cells[axis] - 1 - i;
      int index = cell_index(grid, cell);
      passed |= marks[index];
      marks[index] = passed;
      if (is_opaque(cell_sides[index], face_of(axis, way > 0))) passed = 0u;
    }
  }
}
