#version 450 core
// Patches of one light at a depth, from their four parts each: min-max mipmaps, and sums where SAMPLED is not set.
#include "screen/lights/patches/light_patches.glsl"
#include "shared/group_sizes.shared.h"

layout(local_size_x = LINEAR_GROUP) in;

void add_part(LightPatch part, vec3 origin, inout LightPatch sum) {
  float weight = luminance(part.flux);
  sum.position += weight * (part.position - origin);
  sum.normal += weight * part.normal;
  sum.flux += part.flux;
  sum.area_m2 += part.area_m2;
}

void main() {
  int index = int(global_index());
  if (index >= patches_of_light()) return;
  int first_part = first_of_depth(root_count, depth + 1) + (first_root << (2 * depth + 2)) + 4 * index;
  PatchRange range = PatchRange(vec3(1.0), PATCH_BACKGROUND, vec3(-1.0), 0.0);
  LightPatch sum = LightPatch(vec3(0.0), 0.0, vec3(0.0), 0.0, vec3(0.0), 0.0);
  vec3 origin = patches[first_part].position;
  for (int k = 0; k < 4; ++k) {
    PatchRange part = ranges[first_part + k];
    range = PatchRange(min(range.least, part.least), min(range.nearest, part.nearest), max(range.most, part.most),
                       max(range.farthest, part.farthest));
    LightPatch light_part = patches[first_part + k];
    sum.measure += light_part.measure;
    sum.bound_m2 = max(sum.bound_m2, 4.0 * light_part.bound_m2);
#ifndef SAMPLED
    add_part(light_part, origin, sum);
#endif
  }
  sum.bound_m2 = bound_of(range, sum.bound_m2);
#ifdef SAMPLED
  set_light(index, sum);
#else
  float weight = luminance(sum.flux);
  sum.position = origin + (weight > 0.0 ? sum.position / weight : vec3(0.0));
  sum.normal = dot(sum.normal, sum.normal) > 0.0 ? normalize(sum.normal) : vec3(0.0);
#endif
  ranges[place_of(index)] = range;
  patches[place_of(index)] = sum;
}
