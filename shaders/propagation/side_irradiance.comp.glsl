#version 450 core
// Irradiance per side from what it has received, before smoothing: times its weight in means.
#include "shared/global_index.shared.h"
#include "shared/grid.shared.h"
#include "shared/side.shared.h"

layout(local_size_x = 64) in;
layout(std430, binding = 4) readonly buffer Sides { Side sides[]; };
layout(std430, binding = 5) readonly buffer SideCount { uint side_count; };
layout(std430, binding = 6) readonly buffer TotalDirect { vec4 total_direct[]; };      // first arrival of emission
layout(std430, binding = 7) readonly buffer TotalIndirect { vec4 total_indirect[]; };  // everything after
layout(std430, binding = 8) readonly buffer EmittedFlux { vec4 emitted_flux[]; };
layout(std430, binding = 9) readonly buffer PunctualFlux { vec4 punctual_flux[]; };
layout(std430, binding = 10) writeonly buffer Direct { vec4 direct[]; };      // rgb: E * weight [W], a: weight [m^2]
layout(std430, binding = 11) writeonly buffer Indirect { vec4 indirect[]; };

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
