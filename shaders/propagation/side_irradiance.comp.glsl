#version 450 core
// Irradiance per side from what it has received, before smoothing: times its weight in means.
#include "propagation/answer.glsl"
#include "propagation/slots.shared.h"
#include "shared/global_index.shared.h"
#include "shared/grid.shared.h"
#include "shared/group_sizes.shared.h"
#include "voxel/side_count.glsl"
#include "voxel/sides.glsl"

layout(local_size_x = LINEAR_GROUP) in;
// rgb: E * weight [W], a: weight [m^2].
layout(std430, binding = WEIGHTED_DIRECT_SLOT) writeonly buffer Direct { vec4 direct[]; };
layout(std430, binding = WEIGHTED_INDIRECT_SLOT) writeonly buffer Indirect { vec4 indirect[]; };

void main() {
  uint i = global_index();
  if (i >= side_count) return;
  Side side = sides[i];
  int axis = face_axis(side.face);
  float weight = side_weight(side.normal, axis, side.area_m2);
  vec3 first = side_irradiance(total_direct[i].rgb, emitted_flux[i].rgb, side.albedo, side.normal, axis, side.area_m2, side.face_m2);
  vec3 rest = side_irradiance(total_indirect[i].rgb, punctual_flux[i].rgb, side.albedo, side.normal, axis, side.area_m2, side.face_m2);
  direct[i] = vec4(first * weight, weight);
  indirect[i] = vec4(rest * weight, weight);
}
