#version 450 core
// Between two orders: what sides have received is added to the total, and what they return (plus the sources that start
// with this order) becomes what they send. docs/conventions.md#volume-quantities.
#include "shared/global_index.shared.h"
#include "shared/side.shared.h"

layout(local_size_x = 64) in;
layout(std430, binding = 4) readonly buffer Sides { Side sides[]; };
layout(std430, binding = 5) readonly buffer SideCount { uint side_count; };
layout(std430, binding = 6) buffer Received { vec4 received[]; };
layout(std430, binding = 7) writeonly buffer Sent { vec4 sent[]; };
layout(std430, binding = 8) buffer Total { vec4 total[]; };              // direct or indirect, as the order is
layout(std430, binding = 9) readonly buffer Source { vec4 source_flux[]; };  // flux that lit surfaces send [W]
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
