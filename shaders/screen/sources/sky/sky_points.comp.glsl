#version 450 core
// Sky light that points on surfaces reflect, each from a subset of the sky's parts: candidates for virtual lights.
#include "screen/sources/sky/sky_parts.glsl"
#include "shared/global_index.shared.h"
#include "shared/group_sizes.shared.h"
#include "shared/virtual_light.shared.h"

layout(local_size_x = LINEAR_GROUP) in;
layout(std430, binding = SKY_POINTS_SLOT) buffer Points { VirtualLight points[]; };  // flux: albedo comes in
uniform int first;
uniform int count;
uniform int subsets;
uniform int sample_index;  // of the pictures that are averaged

void main() {
  int i = int(global_index());
  if (i >= count) return;
  VirtualLight point = points[first + i];
  // Neighbours along the curve take different parts, and all of them together the whole sky.
  int subset = (int((uint(i) * 2654435769u) >> 8) + sample_index) % subsets;
  vec3 e = sky_irradiance(subset, subsets, point.position, point.normal, point.normal) * float(subsets);
  points[first + i].flux = point.flux * e * point.area_m2;
}
