// Light straight from the sky, part by part, each as far as its map lets it through. SkyMaps::bind().
#ifndef VOLGI_SKY_PARTS_GLSL
#define VOLGI_SKY_PARTS_GLSL
#include "screen/sources/sky/slots.shared.h"
#include "shared/octahedral.glsl"

layout(std140, binding = SKY_PARTS_BLOCK) uniform SkyParts { SkyPart sky_parts[SKY_MAX_PARTS]; };
layout(binding = SKY_DEPTH_UNIT) uniform sampler2DArray sky_depth;
layout(binding = SKY_NORMAL_UNIT) uniform sampler2DArray sky_normal;  // geometric, octahedral, on the sky's side
layout(binding = SKY_TINT_UNIT) uniform sampler2DArray sky_tint;      // of glass, and the depth of the nearest pane
uniform int sky_glass;  // 1 where there is some
uniform int sky_detailed;  // 1: part k + part_count has the same part's map of what stands on the ground
uniform int sky_resolution;
uniform int part_count;

// Texel coordinates, and depth [m].
vec3 sky_uvz(int part, vec3 position) {
  return vec3(dot(sky_parts[part].column.xyz, position) + sky_parts[part].column.w,
              dot(sky_parts[part].row.xyz, position) + sky_parts[part].row.w,
              dot(sky_parts[part].way.xyz, position) + sky_parts[part].way.w);
}

// Whether the surface in a texel hides a point from the part, as rsm_occluder() of shared/reflective_shadow_map.glsl
// tells it. @param uvz  the point in the map.
bool sky_texel_hides(int part, ivec2 texel, vec3 uvz, vec3 position, vec3 geometric) {
  float depth = texelFetch(sky_depth, ivec3(texel, part), 0).r;
  float z = (1.0 - depth) * sky_parts[part].one_column.w;
  vec2 off = vec2(texel) + 0.5 - uvz.xy;
  vec3 d = off.x * sky_parts[part].one_column.xyz + off.y * sky_parts[part].one_row.xyz +
           (z - uvz.z) * sky_parts[part].way.xyz;
  float error = sky_parts[part].one_row.w + length(position) / 1048576.0 + length(d) * OCTAHEDRAL_ERROR_RAD;
  // Software rasterizers run both sides of a branch, but leave loops: few points have anything above their plane.
  int above = depth > 0.0 && dot(d, geometric) > error ? 1 : 0;
  bool hides = false;
  for (int k = 0; k < above; ++k) {
    hides = dot(d, octahedral_decode(texelFetch(sky_normal, ivec3(texel, part), 0).rg)) > error;
  }
  return hides;
}

// The nearest texel tells: between four, light would come in along the inner edges of rooms whose walls are thinner than
// a texel, and not than half of one; nothing that one of the four hides is half a texel of shadow too much (8 % of a
// court's light in maps of 128). Where the texel met nothing, at the rim of the scene, those beside it are asked: what
// lies inside of a thin slab is not at its rim.
// @param tint  what the glass in front of the point leaves; as rsm_texel_tint().
bool sky_part_visible(int part, vec3 position, vec3 geometric, out vec3 tint) {
  int closer = part + sky_detailed * part_count;
  vec3 uvz = sky_uvz(closer, position);
  float rim = float(sky_resolution) - 1.0;
  bool within = min(uvz.x, uvz.y) > 1.0 && max(uvz.x, uvz.y) < rim;
  if (within) part = closer;
  else uvz = sky_uvz(part, position);
  ivec2 last = ivec2(sky_resolution - 1);
  ivec2 texel = clamp(ivec2(uvz.xy), ivec2(0), last);
  bool hidden = sky_texel_hides(part, texel, uvz, position, geometric);
  int beside = texelFetch(sky_depth, ivec3(texel, part), 0).r <= 0.0 ? 3 : 0;
  ivec2 towards = ivec2(greaterThan(fract(uvz.xy), vec2(0.5))) * 2 - 1;
  for (int k = 1; k <= beside; ++k) {
    ivec2 corner = clamp(texel + towards * ivec2(k & 1, k >> 1), ivec2(0), last);
    hidden = hidden || sky_texel_hides(part, corner, uvz, position, geometric);
  }
  tint = vec3(1.0);
  for (int k = 0; k < sky_glass; ++k) {
    vec4 pane = texelFetch(sky_tint, ivec3(texel, part), 0);
    float range = sky_parts[part].one_column.w;
    float beyond = uvz.z - (1.0 - pane.a) * range;
    if (pane.a > 0.0 && beyond > range / 1024.0) tint = pane.rgb;
  }
  return !hidden;
}

// Irradiance from parts first, first + step, ... A part must stand above both horizons.
vec3 sky_irradiance(int first, int step, vec3 position, vec3 normal, vec3 geometric) {
  vec3 sum = vec3(0.0);
  for (int part = first; part < part_count; part += step) {
    float cosine = -dot(normal, sky_parts[part].way.xyz);
    bool above = min(cosine, -dot(geometric, sky_parts[part].way.xyz)) > 0.0;
    vec3 tint;
    if (above && sky_part_visible(part, position, geometric, tint))
      sum += tint * (cosine * sky_parts[part].irradiance.rgb);
  }
  return sum;
}

#endif
