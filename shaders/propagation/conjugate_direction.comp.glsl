#version 450 core
// The next direction d = q + beta d.
#include "propagation/solver.glsl"

void main() {
  for (uint i = gl_GlobalInvocationID.x; i < side_count; i += STRIDE) {
    sent[i] = vec4(residual[i].rgb + state.turn.rgb * sent[i].rgb, 0.0);
  }
}
