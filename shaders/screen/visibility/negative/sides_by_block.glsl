// Sides in the order of blocks of 8 x 8 x 8 cells, and of cells in a block: neighbours in the list are neighbours in
// space, in all three directions, so that equal steps through sums over it are an even choice and stay one as light
// moves. (Rows of cells, the order of the volume's own list, are near in one direction only.)
#ifndef VOLGI_SIDES_BY_BLOCK_GLSL
#define VOLGI_SIDES_BY_BLOCK_GLSL
#include "screen/visibility/negative/negative_candidates.shared.h"
#include "screen/visibility/negative/open_cells.glsl"
#include "screen/visibility/negative/slots.shared.h"

#define BLOCK_ROWS (BLOCK_EDGE * BLOCK_EDGE)  // of cells along x

layout(std430, binding = SIDES_BY_BLOCK_SLOT) buffer SidesByBlock { uint sides_by_block[]; };
#ifdef WRITES_LIST
// Counts first, then where each block begins.
layout(std430, binding = BLOCK_STARTS_SLOT) buffer BlockStarts { uint block_starts[]; };
#endif

ivec3 blocks_of_grid() { return (grid.cells + BLOCK_EDGE - 1) / BLOCK_EDGE; }

int block_count() {
  ivec3 blocks = blocks_of_grid();
  return blocks.x * blocks.y * blocks.z;
}

// Cell k of a block, or one outside the grid.
ivec3 cell_of_block(int block, int k) {
  ivec3 blocks = blocks_of_grid();
  ivec3 at = ivec3(block % blocks.x, block / blocks.x % blocks.y, block / (blocks.x * blocks.y));
  return at * BLOCK_EDGE + ivec3(k % BLOCK_EDGE, k / BLOCK_EDGE % BLOCK_EDGE, k / (BLOCK_EDGE * BLOCK_EDGE));
}

// None behind the last block.
uint sides_of_row(int block, int row) {
  uint count = 0u;
  for (int k = 0; k < BLOCK_EDGE && block < block_count(); ++k) {
    ivec3 cell = cell_of_block(block, row * BLOCK_EDGE + k);
    if (cell_inside(grid, cell)) count += count_bits(cell_sides[cell_index(grid, cell)].y & 63u);
  }
  return count;
}

#endif
