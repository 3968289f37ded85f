#version 450 core
// The lowest bin such that no more than `most` pixels lie in it and above.
#include "screen/gather/interleaved/exact_pixels.glsl"
#include "screen/gather/interleaved/slots.shared.h"

layout(local_size_x = 64) in;
layout(std430, binding = ERROR_BINS_SLOT) buffer Bins { uint threshold; uint count[]; };
uniform uint max_pixels;
shared uint sums[64];

void main() {
  uint me = gl_LocalInvocationIndex;
  uint each = uint(ERROR_BINS) / 64u;
  uint sum = 0u;
  for (uint i = 0u; i < each; ++i) sum += count[me * each + i];
  sums[me] = sum;
  barrier();
  if (me != 0u) return;
  uint above = 0u;
  uint part = 64u;
  while (part > 0u && above + sums[part - 1u] <= max_pixels) above += sums[--part];
  uint bin = part * each;
  while (bin > 1u && above + count[bin - 1u] <= max_pixels) above += count[--bin];
  threshold = max(bin, 1u);  // where no error is estimated, nothing is done again
}
