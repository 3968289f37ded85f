#version 450 core
// Lists each block's sides. One thread a block.
#define MAKES_THE_LIST
#include "screen/visibility/negative/sides_by_block.glsl"

layout(local_size_x = 64) in;

void main() {
  int block = int(gl_GlobalInvocationID.x);
  if (block >= block_count()) return;
  uint next = block_starts[block];
  for (int k = 0; k < BLOCK_EDGE * BLOCK_EDGE * BLOCK_EDGE; ++k) {
    ivec3 cell = cell_of_block(block, k);
    if (!cell_inside(grid, cell)) continue;
    uvec2 own_sides = cell_sides[cell_index(grid, cell)];
    uint count = count_bits(own_sides.y & 63u);
    for (uint i = 0u; i < count; ++i, ++next) {
      if (next < uint(sides_by_block.length())) sides_by_block[next] = own_sides.x + i;
    }
  }
}
