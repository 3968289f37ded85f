#version 450 core
// The answer is not negative, so this takes it nearer where the last steps have overshot.
#include "propagation/solver.glsl"

void main() {
  for (uint i = gl_GlobalInvocationID.x; i < side_count; i += STRIDE) total[i] = max(total[i], vec4(0.0));
}
