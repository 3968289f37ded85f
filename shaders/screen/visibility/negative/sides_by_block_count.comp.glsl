#version 450 core
// How many sides each block has. One thread a block.
#define MAKES_THE_LIST
#include "screen/visibility/negative/sides_by_block.glsl"

layout(local_size_x = 64) in;

void main() {
  int block = int(gl_GlobalInvocationID.x);
  if (block >= block_count()) return;
  uint count = 0u;
  for (int k = 0; k < BLOCK_EDGE * BLOCK_EDGE * BLOCK_EDGE; ++k) {
    ivec3 cell = cell_of_block(block, k);
    if (cell_inside(grid, cell)) count += count_bits(cell_sides[cell_index(grid, cell)].y & 63u);
  }
  block_starts[block] = count;
}
