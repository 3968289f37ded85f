// A level of pixels and what the next coarser one knows around one of them. Levels are grids of every step-th pixel.
#ifndef VOLGI_AREA_LEVEL_GLSL
#define VOLGI_AREA_LEVEL_GLSL
#include "screen/base/gbuffer.glsl"
#include "screen/gather/area/slots.shared.h"
#include "shared/octahedral.glsl"

layout(binding = AREA_IRRADIANCE_UNIT) uniform sampler2D known_irradiance;
// Of each group of lights a bit in xy: some of them are seen; and in zw: all of them are.
layout(binding = AREA_MASK_UNIT) uniform usampler2D known_mask;
uniform int step_px;

#define LEAST_COSINE 0.8
#define OFF_PLANE 0.2  // sine of the way's angle

// The pixels of the coarser grid that a pixel lies between: one, two or four.
struct Corners {
  ivec2 at[4];
  vec4 weights;  // bilinear; 0: not one of them
  bool whole;    // all of them show the pixel's surface
};

bool shows_surface(vec3 position, vec3 normal, ivec2 at) {
  vec4 there = texelFetch(position_map, at, 0);
  vec3 way = there.xyz - position;
  float height = dot(way, normal);
  return there.w != 0.0 && height * height <= OFF_PLANE * OFF_PLANE * dot(way, way) &&
         dot(octahedral_decode(texelFetch(normal_map, at, 0).xy), normal) >= LEAST_COSINE;
}

Corners corners_of(ivec2 pixel, vec3 position, vec3 normal) {
  int coarse = 2 * step_px;
  ivec2 low = pixel / coarse * coarse, size = textureSize(position_map, 0);
  vec2 t = vec2(pixel - low) / float(coarse);
  Corners c;
  c.whole = true;
  for (int k = 0; k < 4; ++k) {
    ivec2 corner = ivec2(k & 1, k >> 1);
    vec2 w = mix(1.0 - t, t, vec2(corner));
    ivec2 at = low + corner * coarse;
    bool inside = all(lessThan(at, size));
    c.at[k] = min(at, size - 1);
    c.weights[k] = w.x * w.y;
    if (c.weights[k] > 0.0) c.whole = c.whole && inside && shows_surface(position, normal, at);
  }
  return c;
}

// Groups of which all corners see every light, and of which none sees any; 0 of both where they are not whole.
void agreed(Corners c, out uvec2 seen, out uvec2 hidden) {
  seen = uvec2(0xffffffffu);
  hidden = uvec2(0xffffffffu);
  for (int k = 0; k < 4; ++k) {
    if (c.weights[k] <= 0.0) continue;
    uvec4 mask = texelFetch(known_mask, c.at[k], 0);
    seen &= mask.zw;
    hidden &= ~mask.xy;
  }
  if (!c.whole) {
    seen = uvec2(0u);
    hidden = uvec2(0u);
  }
}

#endif
