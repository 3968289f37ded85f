#version 450 core
// Adds the offset of its group to every cell's first side.
#include "shared/grid.shared.h"

layout(local_size_x = 256) in;
layout(std140, binding = 0) uniform GridBlock { Grid grid; };
layout(std430, binding = 3) buffer CellSides { uvec2 cell_sides[]; };
layout(std430, binding = 4) readonly buffer GroupTotals { uint group_totals[]; };

void main() {
  uint cell = gl_GlobalInvocationID.x;
  if (cell >= uint(grid.cells.x * grid.cells.y * grid.cells.z)) return;
  cell_sides[cell].x += group_totals[gl_WorkGroupID.x];
}
