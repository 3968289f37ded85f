#version 450 core
// Starts an order: every side sends its power into the cell that sees it; empty cells start dark.
// Set by the program: ORDER = 2
#include "propagation/crossing.glsl"
#include "propagation/slots.shared.h"
#include "shared/group_sizes.shared.h"
#include "voxel/cell_sides.glsl"
#include "voxel/grid_block.glsl"

layout(local_size_x = CELL_GROUP_X, local_size_y = CELL_GROUP_Y, local_size_z = CELL_GROUP_Z) in;
layout(binding = NEXT_LOBES_IMAGE, rgba32f) uniform restrict writeonly image3D next_lobes;
layout(std430, binding = SENT_SLOT) readonly buffer Sent { vec4 sent[]; };  // power per side [W]

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
