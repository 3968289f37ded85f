#version 450 core
// What lobes reflect of light straight from emissive surfaces: by lights, as far as their groups are seen; or by
// samples of their pictures, as light as the block of 2 x 2 pixels has found them seen.
// Set by the program: PHONG, where mirrors are Phong lobes
#include "screen/gather/area/lobe_samples.glsl"
#include "shared/disk_to_point.shared.h"
#include "shared/group_sizes.shared.h"

layout(local_size_x = SQUARE_GROUP, local_size_y = SQUARE_GROUP) in;
layout(binding = AREA_LOBE_KIND_UNIT) uniform usampler2D kinds;
layout(binding = AREA_LOBE_WAYS_UNIT) uniform sampler2D ways[3];
layout(binding = AREA_PANELS_UNIT) uniform sampler2DArray pictures;
layout(binding = AREA_RADIANCE_IMAGE, rgba32f) uniform writeonly image2D radiance;
uniform int light_count;
uniform int per_group;

// Pixels of fine levels have asked for a quarter of each group: as far as a group is seen from all of its surface
// around a pixel, by the weights of join.comp.glsl.
vec3 by_lights(Receiver r, ivec2 pixel) {
  uvec4 masks[9];
  float weights[9], total = 0.0;
  for (int j = 0; j < 9; ++j) {
    ivec2 off = ivec2(j % 3, j / 3) - 1, at = pixel + off;
    bool inside = all(greaterThanEqual(at, ivec2(0))) && all(lessThan(at, textureSize(position_map, 0)));
    bool alike = off == ivec2(0) || (inside && shows_surface(r.position, r.lobe.normal, at));
    masks[j] = alike ? texelFetch(known_mask, at, 0) : uvec4(0u);
    weights[j] = alike ? float((2 - abs(off.x)) * (2 - abs(off.y))) : 0.0;
    total += weights[j];
  }
  vec3 sum = vec3(0.0);
  for (int group = 0; group * per_group < light_count; ++group) {
    uint bit = uint(group & 31);
    float seen = 0.0;
    for (int j = 0; j < 9; ++j) {
      uint some = group < 32 ? masks[j].x : masks[j].y, every = group < 32 ? masks[j].z : masks[j].w;
      seen += weights[j] * float((some >> bit & 1u) + (every >> bit & 1u));
    }
    if (seen == 0.0) continue;
    for (int k = group * per_group; k < min((group + 1) * per_group, light_count); ++k) {
      VirtualLight light = area_lights[k];
      vec3 w = light.position - r.position;
      float squared = dot(w, w), height = -dot(w, light.normal), along = dot(w, r.lobe.normal);
      if (min(height, min(along, dot(w, r.geometric))) <= 0.0) continue;
      vec3 l = w * inversesqrt(squared);
      float form = disk_to_point(height, along, -dot(light.normal, r.lobe.normal), squared, light.area_m2);
      vec3 reflectance = lobe_reflectance(r.lobe, l, max(dot(l, r.lobe.normal), 1e-4));
      sum += light.flux * reflectance * (form * seen * 0.5 / total);
    }
  }
  return sum;
}

// Of one sample: 1 where nothing lies on its way. Chebyshev's bound of what is farther than the mean.
float lit_share(ivec2 at, int m) {
  vec4 two = texelFetch(ways[0], at, 0);
  if (m >> 1 == 1) two = texelFetch(ways[1], at, 0);
  if (m >> 1 == 2) two = texelFetch(ways[2], at, 0);
  vec2 moments = (m & 1) == 0 ? two.xy : two.zw;
  float beyond = 1.0 - moments.x, variance = max(moments.y - moments.x * moments.x, 1e-6);
  return beyond < 1e-3 ? 1.0 : variance / (variance + beyond * beyond);
}

vec3 by_samples(Receiver r, ivec2 pixel) {
  mat3 frame = frame_around(r.lobe.mirrored);
  vec3 sum = vec3(0.0);
  ivec2 size = textureSize(position_map, 0);
  for (int k = 0; k < LOBE_SAMPLES; ++k) {
    LobeSample s = lobe_sample(r.lobe, frame, k);
    float cosine = dot(s.direction, r.lobe.normal);
    if (min(cosine, dot(s.direction, r.geometric)) <= 0.0) continue;
    PanelHit hit = panel_along(r.position, s.direction);
    if (hit.panel < 0) continue;
    float across_m2 = s.solid_angle * hit.distance_m * hit.distance_m / hit.cosine;
    float texels = sqrt(across_m2 / panels[hit.panel].area_m2) * float(PANEL_TEXELS);
    vec3 emitted = textureLod(pictures, vec3(0.25 + 0.5 * hit.uv, hit.panel), max(log2(texels), 0.0)).rgb;
    ivec2 at = min((pixel & ~1) + ivec2(k & 1, k >> 1 & 1), size - 1);
    if (texelFetch(kinds, at, 0).r != LOBE_NARROW || !shows_surface(r.position, r.lobe.normal, at)) at = pixel;
    sum += emitted * lobe_reflectance(r.lobe, s.direction, cosine) * (cosine * s.solid_angle * lit_share(at, k >> 2));
  }
  return sum;
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, textureSize(position_map, 0)))) return;
  uint kind = texelFetch(kinds, pixel, 0).r;
  vec3 sum = vec3(0.0);
  Receiver r;
  if (kind != LOBE_NONE && receiver_at(pixel, r))
    sum = r.apart * (kind == LOBE_WIDE ? by_lights(r, pixel) : by_samples(r, pixel));
  imageStore(radiance, pixel, vec4(sum, kind == LOBE_NONE ? 0.0 : 1.0));
}
