#version 450 core
// P = K(e + v) has been received: residual q = fP - v, first direction d = q.
#include "propagation/solver.glsl"

void main() {
  vec3 product = vec3(0.0), next = vec3(0.0), all = vec3(0.0);
  for (uint i = gl_GlobalInvocationID.x; i < side_count; i += STRIDE) {
    vec3 f = returned_fraction(i);
    vec3 hit = received[i].rgb;
    vec3 q = f * hit - residual[i].rgb;
    product += product_term(i, f, q, q);
    next += abs(q);
    all += source[i].rgb + f * hit;
    total[i] = vec4(hit, 0.0);
    residual[i] = vec4(q, 0.0);
    sent[i] = vec4(q, 0.0);
    received[i] = vec4(0.0);
  }
  put_sums(product, next, all);
}
