#version 450 core
// Joins the subsets of a block along one axis, and then the other: any window as large as a block has each once. Pixels
// of other surfaces, or that shine otherwise, do not count (Laine et al. 2007, "Incremental Instant Radiosity", section
// 4.2).
#include "screen/base/gbuffer.glsl"
#include "screen/bounces/glossy/slots.shared.h"
#include "shared/group_sizes.shared.h"
#include "shared/octahedral.glsl"

layout(local_size_x = SQUARE_GROUP, local_size_y = SQUARE_GROUP) in;
layout(binding = GBUFFER_DIFFUSE_UNIT) uniform sampler2D diffuse_map;
layout(binding = GBUFFER_MIRROR_UNIT) uniform sampler2D mirror_map;
layout(binding = GLOSSY_DIRECT_UNIT) uniform sampler2D direct_parts;
layout(binding = GLOSSY_INDIRECT_UNIT) uniform sampler2D indirect_parts;
layout(binding = GLOSSY_DIRECT_IMAGE, rgba32f) uniform writeonly image2D direct;
layout(binding = GLOSSY_INDIRECT_IMAGE, rgba32f) uniform writeonly image2D indirect;
uniform int interleave;
uniform ivec2 axis;

#define LEAST_COSINE 0.95
#define OFF_PLANE 0.2  // sine of the way's angle
#define ALIKE 0.1      // of reflectance and roughness

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy), size = textureSize(position_map, 0);
  if (any(greaterThanEqual(pixel, size))) return;
  vec4 d = texelFetch(direct_parts, pixel, 0), i = texelFetch(indirect_parts, pixel, 0);
  if (d.w > 0.0) {
    vec3 position = texelFetch(position_map, pixel, 0).xyz;
    vec3 normal = octahedral_decode(texelFetch(normal_map, pixel, 0).xy);
    vec4 mirror = texelFetch(mirror_map, pixel, 0);
    float roughness = texelFetch(diffuse_map, pixel, 0).a;
    for (int k = -interleave / 2; k < interleave - interleave / 2; ++k) {
      ivec2 at = pixel + k * axis;
      if (k == 0 || any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, size))) continue;
      vec4 there = texelFetch(direct_parts, at, 0);
      vec3 way = texelFetch(position_map, at, 0).xyz - position;
      float height = dot(way, normal);
      bool alike = there.w > 0.0 && height * height <= OFF_PLANE * OFF_PLANE * dot(way, way) &&
                   dot(octahedral_decode(texelFetch(normal_map, at, 0).xy), normal) >= LEAST_COSINE &&
                   abs(texelFetch(diffuse_map, at, 0).a - roughness) < ALIKE &&
                   all(lessThan(abs(texelFetch(mirror_map, at, 0) - mirror), vec4(ALIKE)));
      if (!alike) continue;
      d += vec4(there.rgb, 1.0);
      i += vec4(texelFetch(indirect_parts, at, 0).rgb, 1.0);
    }
    d = vec4(d.rgb / d.w, 1.0);
    i = vec4(i.rgb / i.w, 1.0);
  }
  imageStore(direct, pixel, d);
  imageStore(indirect, pixel, i);
}
