#version 450 core
// Adds the partial sums of 64 groups, and makes of them what the next kernel and the host look at.
#include "propagation/slots.shared.h"
#include "shared/bounce_state.shared.h"

layout(local_size_x = BOUNCE_PARTIALS) in;
layout(std430, binding = PARTIALS_SLOT) readonly buffer Partials { vec4 partials[]; };
layout(std430, binding = STATE_SLOT) buffer State { BounceState state; };
uniform int sums;  // BOUNCE_SUMS_*

shared vec4 running[3][BOUNCE_PARTIALS];

vec4 quotient(vec4 a, vec4 b) { return mix(vec4(0.0), a / max(b, vec4(1e-37)), greaterThan(b, vec4(0.0))); }

void main() {
  uint lane = gl_LocalInvocationID.x;
  for (int k = 0; k < 3; ++k) running[k][lane] = partials[3u * lane + uint(k)];
  barrier();
  for (uint half_count = BOUNCE_PARTIALS / 2; half_count > 0u; half_count >>= 1) {
    if (lane < half_count) {
      for (int k = 0; k < 3; ++k) running[k][lane] += running[k][lane + half_count];
    }
    barrier();
  }
  if (lane != 0u) return;
  vec4 sum = running[0][0];
  if (sums == BOUNCE_SUMS_SOURCE) {
    state.last_source_power = state.source_power;
    state.source_power = sum;
    state.share = quotient(sum, state.last_source_power);
  } else if (sums == BOUNCE_SUMS_CURVATURE) {
    state.step_size = quotient(state.product, max(sum, BOUNCE_MIN_LOSS * running[1][0]));
  } else {
    if (sums == BOUNCE_SUMS_RESIDUAL) {
      state.turn = quotient(sum, state.product);
      state.product = sum;
    }
    state.next_sent = running[1][0];
    state.total_sent = running[2][0];
  }
}
