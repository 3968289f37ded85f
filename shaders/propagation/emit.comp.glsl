#version 450 core
// Starts an order: every side sends its power into the cell that sees it; empty cells start dark.
// Set by the program: ORDER = 2
#include "shared/grid.shared.h"
#include "shared/side.shared.h"
#include "propagation/crossing.glsl"

layout(local_size_x = 8, local_size_y = 8, local_size_z = 4) in;
layout(std140, binding = 0) uniform GridBlock { Grid grid; };
layout(binding = 0, rgba32f) uniform restrict writeonly image3D next_lobes;
layout(std430, binding = 3) readonly buffer CellSides { uvec2 cell_sides[]; };
layout(std430, binding = 7) readonly buffer Sent { vec4 sent[]; };  // power per side [W]

void main() {
  ivec3 c = ivec3(gl_GlobalInvocationID);
  if (!cell_inside(grid, c)) return;
  uvec2 own_sides = cell_sides[cell_index(grid, c)];
  Lobes sum = dark_lobes();
  for (int face = 0; face < 6; ++face) {
    if (has_side(own_sides, face)) add_lobes(sum, sent[side_index(own_sides, face)].rgb, lobe_of_side(face));
  }
  keep_power(sum);
  STORE_LOBES(next_lobes, c, grid.cells.z, sum);
}
