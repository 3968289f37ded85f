// All bounces at once: P = K(e + fP), by conjugate gradients or by P <- K(e + fP); see propagation/bounces_cpu.h for the
// equations. Kernels run as 64 groups of 256 threads that stride over the sides, so that sums have a fixed order.
#include "propagation/slots.shared.h"
#include "shared/bounce_state.shared.h"
#include "voxel/side_count.glsl"
#include "voxel/sides.glsl"

layout(local_size_x = 256) in;
layout(std430, binding = RECEIVED_SLOT) buffer Received { vec4 received[]; };  // y = K d, or P of the order
layout(std430, binding = SENT_SLOT) buffer Sent { vec4 sent[]; };              // d, or e + fP
layout(std430, binding = TOTAL_SLOT) buffer Total { vec4 total[]; };           // P
layout(std430, binding = SOURCE_SLOT) buffer Source { vec4 source[]; };        // e [W]
layout(std430, binding = PARTIALS_SLOT) buffer Partials { vec4 partials[]; };  // three sums for each of the 64 groups
layout(std430, binding = STATE_SLOT) readonly buffer State { BounceState state; };
layout(std430, binding = RESIDUAL_SLOT) buffer Residual { vec4 residual[]; };  // q

const uint STRIDE = BOUNCE_PARTIALS * 256u;

vec3 returned_fraction(uint i) {
  Side side = sides[i];
  if (side.coverage <= 0.0 || side.face_m2 <= 0.0) return vec3(0.0);
  return side_returned_fraction(side.albedo, side.area_m2, side.face_m2);
}

// Term of <a,b> = sum of a b / (f tau), in units of the sources' power, so that no square overflows or vanishes.
vec3 product_term(uint i, vec3 f, vec3 a, vec3 b) {
  vec3 unit = mix(vec3(1.0), state.source_power.rgb, greaterThan(state.source_power.rgb, vec3(0.0)));
  vec3 weight = f * min(sides[i].coverage, 1.0);
  return mix(vec3(0.0), (a / unit) * (b / unit) / max(weight, vec3(1e-30)), greaterThan(weight, vec3(0.0)));
}

shared vec4 running[3][256];

void put_sums(vec3 a, vec3 b, vec3 c) {
  uint lane = gl_LocalInvocationID.x;
  running[0][lane] = vec4(a, 0.0);
  running[1][lane] = vec4(b, 0.0);
  running[2][lane] = vec4(c, 0.0);
  barrier();
  for (uint half_count = 128u; half_count > 0u; half_count >>= 1) {
    if (lane < half_count) {
      for (int k = 0; k < 3; ++k) running[k][lane] += running[k][lane + half_count];
    }
    barrier();
  }
  if (lane < 3u) partials[3u * gl_WorkGroupID.x + lane] = running[lane][0];
}
