#version 450 core
// Power per side sent in all orders: what the radiance in free space follows from.
#include "propagation/answer.glsl"
#include "propagation/slots.shared.h"
#include "shared/global_index.shared.h"
#include "shared/group_sizes.shared.h"
#include "voxel/side_count.glsl"
#include "voxel/sides.glsl"

layout(local_size_x = LINEAR_GROUP) in;
layout(std430, binding = TOTAL_SENT_SLOT) writeonly buffer Sent { vec4 sent[]; };

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
