#version 450 core
// Open cells make those open that follow them along an axis, both ways, up to faces that stop everything. One thread a
// column.
#include "shared/global_index.shared.h"
#include "screen/visibility/negative/open_cells.glsl"
#include "shared/group_sizes.shared.h"

layout(local_size_x = LINEAR_GROUP) in;
uniform int axis;

void main() {
  int b = axis_b(axis), c = axis_c(axis);
  int column = int(global_index());
  if (column >= grid.cells[b] * grid.cells[c]) return;
  ivec3 cell = ivec3(0);
  cell[b] = column % grid.cells[b];
  cell[c] = column / grid.cells[b];
  for (int way = 1; way >= -1; way -= 2) {
    bool open = false;
    for (int i = 0; i < grid.cells[axis]; ++i) {
      cell[axis] = way > 0 ? i : grid.cells[axis] - 1 - i;
      int index = cell_index(grid, cell);
      if (open) open_cells[index] = 1u;
      open = open_cells[index] != 0u && !face_is_opaque(cell, face_of(axis, way > 0));
    }
  }
}
