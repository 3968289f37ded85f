#version 450 core
// An answer for another number of sides is none.
#include "propagation/slots.shared.h"
#include "propagation/solver.glsl"

layout(std430, binding = FIRST_ARRIVAL_SLOT) buffer Direct { vec4 direct[]; };
layout(std430, binding = LAST_COUNT_SLOT) readonly buffer LastCount { uint last_count; };

void main() {
  if (last_count == side_count) return;
  for (uint i = gl_GlobalInvocationID.x; i < side_count; i += STRIDE) {
    direct[i] = vec4(0.0);
    total[i] = vec4(0.0);
    received[i] = vec4(0.0);
  }
}
