#version 450 core
// Sum of a power per side, in a fixed order: 64 partial sums by 64 groups (sum_partials adds them).
#include "propagation/partial_sums.shared.h"
#include "propagation/slots.shared.h"
#include "voxel/side_count.glsl"

layout(local_size_x = 256) in;
layout(std430, binding = SENT_SLOT) readonly buffer Sent { vec4 sent[]; };
layout(std430, binding = PARTIALS_SLOT) writeonly buffer Partials { vec4 partials[]; };

shared vec4 running[256];

void main() {
  uint lane = gl_LocalInvocationID.x;
  vec4 sum = vec4(0.0);
  for (uint i = gl_GlobalInvocationID.x; i < side_count; i += uint(PARTIAL_SUMS) * 256u) sum += sent[i];
  running[lane] = sum;
  barrier();
  for (uint half_count = 128u; half_count > 0u; half_count >>= 1) {
    if (lane < half_count) running[lane] += running[lane + half_count];
    barrier();
  }
  if (lane == 0u) partials[gl_WorkGroupID.x] = running[0];
}
