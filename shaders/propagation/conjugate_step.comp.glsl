#version 450 core
// A step of alpha along d: P += alpha K d, q -= alpha (I - fK) d.
#include "propagation/solver.glsl"

void main() {
  vec3 product = vec3(0.0), next = vec3(0.0), all = vec3(0.0);
  vec3 alpha = state.step_size.rgb;
  for (uint i = gl_GlobalInvocationID.x; i < side_count; i += STRIDE) {
    vec3 f = returned_fraction(i);
    vec3 y = received[i].rgb;
    vec3 power = total[i].rgb + alpha * y;
    vec3 q = residual[i].rgb - alpha * (sent[i].rgb - f * y);
    product += product_term(i, f, q, q);
    next += abs(q);
    all += source[i].rgb + f * power;
    total[i] = vec4(power, 0.0);
    residual[i] = vec4(q, 0.0);
    received[i] = vec4(0.0);
  }
  put_sums(product, next, all);
}
