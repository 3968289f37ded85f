#version 450 core
// Where each block's sides begin. One work group.
#define MAKES_THE_LIST
#include "screen/visibility/negative/sides_by_block.glsl"

layout(local_size_x = 64) in;
shared uint part[64];

void main() {
  int each = (block_count() + 63) / 64;
  int first = int(gl_LocalInvocationIndex) * each;
  int end = min(first + each, block_count());
  uint sum = 0u;
  for (int i = first; i < end; ++i) sum += block_starts[i];
  part[gl_LocalInvocationIndex] = sum;
  barrier();
  sum = 0u;
  for (uint t = 0u; t < gl_LocalInvocationIndex; ++t) sum += part[t];
  for (int i = first; i < end; ++i) {
    uint count = block_starts[i];
    block_starts[i] = sum;
    sum += count;
  }
}
