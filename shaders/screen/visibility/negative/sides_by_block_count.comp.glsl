#version 450 core
// How many sides each block has. A group a block, a row of cells to each of its threads.
#include "shared/global_index.shared.h"
#define WRITES_LIST
#include "screen/visibility/negative/sides_by_block.glsl"

layout(local_size_x = BLOCK_ROWS) in;
shared uint count;

void main() {
  int block = int(group_index());
  if (gl_LocalInvocationIndex == 0u) count = 0u;
  barrier();
  atomicAdd(count, sides_of_row(block, int(gl_LocalInvocationIndex)));
  barrier();
  if (gl_LocalInvocationIndex == 0u && block < block_count()) block_starts[block] = count;
}
