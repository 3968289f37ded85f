#version 450 core
// Adds the 64 partial sums into the sum that the host will look at.
layout(local_size_x = 64) in;
layout(std430, binding = 10) readonly buffer Partials { vec4 partials[]; };
layout(std430, binding = 11) writeonly buffer Sum { vec4 sum; };

shared vec4 running[64];

void main() {
  uint lane = gl_LocalInvocationID.x;
  running[lane] = partials[lane];
  barrier();
  for (uint half_count = 32u; half_count > 0u; half_count >>= 1) {
    if (lane < half_count) running[lane] += running[lane + half_count];
    barrier();
  }
  if (lane == 0u) sum = running[0];
}
