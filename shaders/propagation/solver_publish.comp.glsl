#version 450 core
// P <- K(e + fP): what has been received is the answer, and what that makes sides send is sent next.
#include "propagation/solver.glsl"

void main() {
  vec3 change = vec3(0.0), all = vec3(0.0);
  for (uint i = gl_GlobalInvocationID.x; i < side_count; i += STRIDE) {
    vec3 f = returned_fraction(i);
    vec3 hit = received[i].rgb;
    vec3 power = source[i].rgb + f * hit;
    change += f * abs(hit - total[i].rgb);
    all += power;
    total[i] = vec4(hit, 0.0);
    sent[i] = vec4(power, 0.0);
    received[i] = vec4(0.0);
  }
  put_sums(vec3(0.0), change, all);
}
