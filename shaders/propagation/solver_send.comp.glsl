#version 450 core
// What sides send when they have received the last answer: v = fP in `residual`, e + v in `sent`. Nothing is received
// yet.
#include "propagation/solver.glsl"
uniform bool scaled;  // as the sources have changed since

void main() {
  for (uint i = gl_GlobalInvocationID.x; i < side_count; i += STRIDE) {
    if (scaled) total[i].rgb *= state.share.rgb;
    vec3 v = returned_fraction(i) * total[i].rgb;
    residual[i] = vec4(v, 0.0);
    sent[i] = vec4(source[i].rgb + v, 0.0);
    received[i] = vec4(0.0);
  }
}
