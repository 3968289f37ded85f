#version 450 core
// What sides send before bounces: punctual light, and what they return of the first arrival of emission.
#include "propagation/slots.shared.h"
#include "propagation/solver.glsl"

// First arrival of emission [W].
layout(std430, binding = FIRST_ARRIVAL_SLOT) readonly buffer Direct { vec4 direct[]; };
// Flux that lit surfaces send [W].
layout(std430, binding = SOURCE_PUNCTUAL_SLOT) readonly buffer Punctual { vec4 punctual_flux[]; };

void main() {
  vec3 sum = vec3(0.0);
  for (uint i = gl_GlobalInvocationID.x; i < side_count; i += STRIDE) {
    Side side = sides[i];
    vec3 power = returned_fraction(i) * direct[i].rgb +
                 side_sent_power(punctual_flux[i].rgb, side.albedo, side.area_m2, side.face_m2);
    source[i] = vec4(power, 0.0);
    sum += power;
  }
  put_sums(sum, vec3(0.0), vec3(0.0));
}
