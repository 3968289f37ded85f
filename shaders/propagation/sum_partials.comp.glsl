#version 450 core
// Adds the 64 partial sums into the sum that the host will look at.
#include "propagation/partial_sums.shared.h"
#include "propagation/slots.shared.h"

layout(local_size_x = PARTIAL_SUMS) in;
layout(std430, binding = PARTIALS_SLOT) readonly buffer Partials { vec4 partials[]; };
layout(std430, binding = SUM_SLOT) writeonly buffer Sum { vec4 sum; };

shared vec4 running[PARTIAL_SUMS];

void main() {
  uint lane = gl_LocalInvocationID.x;
  running[lane] = partials[lane];
  barrier();
  for (uint half_count = uint(PARTIAL_SUMS / 2); half_count > 0u; half_count >>= 1) {
    if (lane < half_count) running[lane] += running[lane + half_count];
    barrier();
  }
  if (lane == 0u) sum = running[0];
}
