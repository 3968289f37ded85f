// Light straight from the sky, part by part, each as far as its map lets it through. SkyMaps::bind().
#ifndef VOLGI_SKY_PARTS_GLSL
#define VOLGI_SKY_PARTS_GLSL
#include "screen/sources/sky/slots.shared.h"
#include "shared/octahedral.glsl"

layout(binding = SKY_PARTS_UNIT) uniform samplerBuffer sky_part_texels;
layout(binding = SKY_SURFACE_UNIT) uniform usampler2DArray sky_surface;  // as sky_maps.frag.glsl has it
layout(binding = SKY_TINT_UNIT) uniform sampler2DArray sky_tint;      // of glass, and the depth of the nearest pane
uniform int sky_glass;  // 1 where there is some
uniform int sky_detailed;  // 1: part k + part_count has the same part's map of what stands on the ground
uniform int sky_resolution;
uniform int part_count;

vec4 sky_part_texel(int part, int texel) { return texelFetch(sky_part_texels, SKY_PART_TEXELS * part + texel); }

// A point in the map of one part.
struct SkyMapPoint {
  vec3 uvz;                // texel coordinates, and depth [m]
  vec3 one_column, one_row;  // a texel further [m]
  vec3 way;                // the light's
  float depth_range_m;
  float error_m;  // what comparisons may err at least
};

SkyMapPoint sky_map_point(int part, vec3 position) {
  vec4 column = sky_part_texel(part, 0), row = sky_part_texel(part, 1), way = sky_part_texel(part, 2);
  SkyMapPoint p;
  p.uvz = vec3(dot(column.xyz, position) + column.w, dot(row.xyz, position) + row.w,
               dot(way.xyz, position) + way.w);
  float columns = dot(column.xyz, column.xyz), rows = dot(row.xyz, row.xyz);
  p.one_column = column.xyz / columns;
  p.one_row = row.xyz / rows;
  p.way = way.xyz;
  p.depth_range_m = sky_part_texel(part, 3).w;
  p.error_m = inversesqrt(min(columns, rows)) / 256.0 + (p.depth_range_m + length(position)) / 1048576.0;
  return p;
}

// Whether the surface in a texel hides a point from the part, as rsm_occluder() of shared/reflective_shadow_map.glsl
// tells it.
bool sky_texel_hides(int part, ivec2 texel, SkyMapPoint p, vec3 geometric) {
  uvec2 surface = texelFetch(sky_surface, ivec3(texel, part), 0).rg;
  float depth = uintBitsToFloat(surface.r);
  float z = (1.0 - depth) * p.depth_range_m;
  vec2 off = vec2(texel) + 0.5 - p.uvz.xy;
  vec3 d = off.x * p.one_column + off.y * p.one_row + (z - p.uvz.z) * p.way;
  float error = p.error_m + length(d) * OCTAHEDRAL_ERROR_RAD;
  return depth > 0.0 && min(dot(d, geometric), dot(d, octahedral_decode(unpackSnorm2x16(surface.g)))) > error;
}

// The nearest texel tells: between four, light would come in along the inner edges of rooms whose walls are thinner than
// a texel, and not than half of one; nothing that one of the four hides is half a texel of shadow too much (8 % of a
// court's light in maps of 128). Where the texel met nothing, at the rim of the scene, those beside it are asked: what
// lies inside of a thin slab is not at its rim.
// @param tint  what the glass in front of the point leaves; as rsm_texel_tint().
bool sky_part_visible(int part, vec3 position, vec3 geometric, out vec3 tint) {
  SkyMapPoint p = sky_map_point(part, position);
  float rim = float(sky_resolution) - 1.0;
  for (int k = 0; k < sky_detailed; ++k) {
    SkyMapPoint closer = sky_map_point(part + part_count, position);
    if (min(closer.uvz.x, closer.uvz.y) > 1.0 && max(closer.uvz.x, closer.uvz.y) < rim) {
      part += part_count;
      p = closer;
    }
  }
  ivec2 last = ivec2(sky_resolution - 1);
  ivec2 texel = clamp(ivec2(p.uvz.xy), ivec2(0), last);
  bool hidden = sky_texel_hides(part, texel, p, geometric);
  int beside = texelFetch(sky_surface, ivec3(texel, part), 0).r == 0u ? 3 : 0;
  ivec2 towards = ivec2(greaterThan(fract(p.uvz.xy), vec2(0.5))) * 2 - 1;
  for (int k = 1; k <= beside; ++k) {
    ivec2 corner = clamp(texel + towards * ivec2(k & 1, k >> 1), ivec2(0), last);
    hidden = hidden || sky_texel_hides(part, corner, p, geometric);
  }
  tint = vec3(1.0);
  for (int k = 0; k < sky_glass; ++k) {
    vec4 pane = texelFetch(sky_tint, ivec3(texel, part), 0);
    float beyond = p.uvz.z - (1.0 - pane.a) * p.depth_range_m;
    if (pane.a > 0.0 && beyond > p.depth_range_m / 1024.0) tint = pane.rgb;
  }
  return !hidden;
}

// Irradiance from parts first, first + step, ... A part must stand above both horizons.
vec3 sky_irradiance(int first, int step, vec3 position, vec3 normal, vec3 geometric) {
  vec3 sum = vec3(0.0);
  for (int part = first; part < part_count; part += step) {
    vec3 way = sky_part_texel(part, 2).xyz;
    float cosine = -dot(normal, way);
    // Software rasterizers run both sides of a branch, but leave loops.
    int look = min(cosine, -dot(geometric, way)) > 0.0 ? 1 : 0;
    for (int k = 0; k < look; ++k) {
      vec3 tint;
      if (sky_part_visible(part, position, geometric, tint)) sum += tint * (cosine * sky_part_texel(part, 3).rgb);
    }
  }
  return sum;
}

#endif
