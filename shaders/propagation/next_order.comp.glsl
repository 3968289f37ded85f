#version 450 core
// Between two orders: what sides have received is added to the total, and what they return (plus the sources that start
// with this order) becomes what they send. docs/conventions.md#volume-quantities.
#include "propagation/slots.shared.h"
#include "shared/global_index.shared.h"
#include "shared/group_sizes.shared.h"
#include "voxel/side_count.glsl"
#include "voxel/sides.glsl"

layout(local_size_x = LINEAR_GROUP) in;
layout(std430, binding = RECEIVED_SLOT) buffer Received { vec4 received[]; };
layout(std430, binding = SENT_SLOT) writeonly buffer Sent { vec4 sent[]; };
layout(std430, binding = TOTAL_SLOT) buffer Total { vec4 total[]; };  // direct or indirect, as the order is
// Flux that lit surfaces send [W].
layout(std430, binding = SOURCE_SLOT) readonly buffer Source { vec4 source_flux[]; };
uniform bool add_source;
uniform bool already_reflected;  // hits went on at once (propagate, reflect_hits)

void main() {
  uint i = global_index();
  if (i >= side_count) return;
  Side side = sides[i];
  vec3 hit = received[i].rgb;
  vec3 power = already_reflected ? vec3(0.0) : hit * side_returned_fraction(side.albedo, side.area_m2, side.face_m2);
  if (add_source) power += side_sent_power(source_flux[i].rgb, side.albedo, side.area_m2, side.face_m2);
  total[i].rgb += hit;
  received[i] = vec4(0.0);
  sent[i] = vec4(power, 0.0);
}
