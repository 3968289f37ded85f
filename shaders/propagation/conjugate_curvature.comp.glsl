#version 450 core
// <d, (I - fK) d> and <d,d> of the direction d that has been sent.
#include "propagation/solver.glsl"

void main() {
  vec3 bend = vec3(0.0), square = vec3(0.0);
  for (uint i = gl_GlobalInvocationID.x; i < side_count; i += STRIDE) {
    vec3 f = returned_fraction(i);
    vec3 d = sent[i].rgb;
    bend += product_term(i, f, d, d - f * received[i].rgb);
    square += product_term(i, f, d, d);
  }
  put_sums(bend, square, vec3(0.0));
}
