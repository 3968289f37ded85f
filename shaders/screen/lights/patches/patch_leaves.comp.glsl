#version 450 core
// The finest patches of one light, from all their texels. SAMPLED: their light is that of one (light_patches.glsl);
// else the sum over all.
#include "screen/lights/patches/light_patches.glsl"
#include "shared/group_sizes.shared.h"

layout(local_size_x = LINEAR_GROUP) in;

// Depth and normal of a texel, to the range.
void include(ivec3 texel, ReflectiveShadowLayer view, inout PatchRange range) {
  float depth = texelFetch(rsm_depth, texel, 0).r;
  if (depth <= 0.0) {
    range.farthest = PATCH_BACKGROUND;
    return;
  }
  float z = rsm_z_from_depth(view, depth);
  vec3 normal = octahedral_decode(texelFetch(rsm_normal, texel, 0).rg);
  range.nearest = min(range.nearest, z);
  range.farthest = max(range.farthest, z);
  range.least = min(range.least, normal);
  range.most = max(range.most, normal);
}

// Adds what a texel reflects, by flux; the mean is taken at the end.
void add_texel(ReflectiveShadowLayer view, int layer, ivec2 texel, inout LightPatch sum) {
  int resolution = rsm_lights[light].resolution;
  vec2 uv = (vec2(texel) + 0.5) * (2.0 / float(resolution)) - 1.0;
  float measure = rsm_texel_measure(view, resolution, uv.x, uv.y);
  sum.measure += measure;
  float depth = texelFetch(rsm_depth, ivec3(texel, layer), 0).r;
  if (depth <= 0.0) return;
  vec3 position = rsm_position_from_uvz(view, vec3(uv, rsm_z_from_depth(view, depth)));
  sum.bound_m2 = max(sum.bound_m2, squared_distance(view, position));
#ifndef SAMPLED
  vec3 normal, arriving, albedo;
  if (!rsm_texel(light, layer, texel, position, normal, arriving, albedo)) return;
  vec3 flux = arriving * albedo;
  float weight = luminance(flux);
  sum.position += weight * (position - view.origin);
  sum.normal += weight * normal;
  sum.flux += flux;
  sum.area_m2 += surface_of(view, position, normal, measure);
#endif
}

void main() {
  int index = int(global_index());
  if (index >= patches_of_light()) return;
  Cell cell = cell_of(index);
  ReflectiveShadowLayer view = rsm_layers[rsm_lights[light].first_layer + cell.layer];
  PatchRange range = PatchRange(vec3(1.0), PATCH_BACKGROUND, vec3(-1.0), 0.0);
  LightPatch sum = LightPatch(vec3(0.0), 0.0, vec3(0.0), 0.0, vec3(0.0), 0.0);
  for (int y = cell.first.y - 1; y <= cell.end.y; ++y) {
    for (int x = cell.first.x - 1; x <= cell.end.x; ++x) {
      ivec2 texel = ivec2(x, y);
      include(ivec3(texel, cell.layer), view, range);
      bool inside = all(greaterThanEqual(texel, cell.first)) && all(lessThan(texel, cell.end));
      if (inside) add_texel(view, cell.layer, texel, sum);
    }
  }
  sum.bound_m2 = bound_of(range, sum.bound_m2 * even_measure(view));
#ifdef SAMPLED
  set_light(index, sum);
#else
  float weight = luminance(sum.flux);
  sum.position = view.origin + (weight > 0.0 ? sum.position / weight : vec3(0.0));
  sum.normal = dot(sum.normal, sum.normal) > 0.0 ? normalize(sum.normal) : vec3(0.0);
#endif
  ranges[place_of(index)] = range;
  patches[place_of(index)] = sum;
}
