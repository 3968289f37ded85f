#version 450 core
// Power per side sent in all orders: what the radiance in free space follows from.
#include "shared/global_index.shared.h"
#include "shared/side.shared.h"

layout(local_size_x = 64) in;
layout(std430, binding = 4) readonly buffer Sides { Side sides[]; };
layout(std430, binding = 5) readonly buffer SideCount { uint side_count; };
layout(std430, binding = 6) readonly buffer TotalDirect { vec4 total_direct[]; };      // first arrival of emission
layout(std430, binding = 7) readonly buffer TotalIndirect { vec4 total_indirect[]; };  // everything after
layout(std430, binding = 8) readonly buffer EmittedFlux { vec4 emitted_flux[]; };
layout(std430, binding = 9) readonly buffer PunctualFlux { vec4 punctual_flux[]; };
layout(std430, binding = 10) writeonly buffer Sent { vec4 sent[]; };

void main() {
  uint i = global_index();
  if (i >= side_count) return;
  Side side = sides[i];
  vec3 flux = emitted_flux[i].rgb + punctual_flux[i].rgb;
  vec3 received = total_direct[i].rgb + total_indirect[i].rgb;
  sent[i] = vec4(side_sent_power(flux, side.albedo, side.area_m2, side.face_m2) +
                     received * side_returned_fraction(side.albedo, side.area_m2, side.face_m2),
                 0.0);
}
