#version 450 core
// Lists each block's sides. A group a block, a row of cells to each of its threads.
#include "shared/global_index.shared.h"
#define WRITES_LIST
#include "screen/visibility/negative/sides_by_block.glsl"
#define SCAN_GROUP uint(BLOCK_ROWS)
#include "shared/scan.glsl"

layout(local_size_x = BLOCK_ROWS) in;

void main() {
  int block = int(group_index()), row = int(gl_LocalInvocationIndex);
  uint before = sum_before(sides_of_row(block, row));
  if (block >= block_count()) return;
  uint next = block_starts[block] + before;
  for (int k = 0; k < BLOCK_EDGE; ++k) {
    ivec3 cell = cell_of_block(block, row * BLOCK_EDGE + k);
    if (!cell_inside(grid, cell)) continue;
    uvec2 own_sides = cell_sides[cell_index(grid, cell)];
    uint count = count_bits(own_sides.y & 63u);
    for (uint i = 0u; i < count; ++i, ++next) {
      if (next < uint(sides_by_block.length())) sides_by_block[next] = own_sides.x + i;
    }
  }
}
