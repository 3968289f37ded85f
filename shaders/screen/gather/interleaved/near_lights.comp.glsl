#version 450 core
// Light of sub-lights on the pixels near them.
#include "screen/gather/interleaved/slots.shared.h"
#define SUBLIGHTS_SLOT NEAR_SUBLIGHTS_SLOT
#include "shared/constants.glsl"
#include "screen/lights/resample/sublights.glsl"
#include "screen/base/gbuffer.glsl"
#include "screen/gather/interleaved/near_lights.glsl"

layout(local_size_x = NEAR_TILE, local_size_y = NEAR_TILE) in;
layout(binding = INDIRECT_IMAGE, rgba32f) writeonly uniform image2D indirect;
layout(binding = DIRECT_IMAGE, rgba32f) writeonly uniform image2D direct;
uniform int first_emitted;
uniform int with_direct;

vec3 irradiance_of_light(Receiver at, int i) {
  NearLight light = near_lights[i];
  vec3 way = light.position - at.position;
  float squared = dot(way, way);
  bool behind = dot(way, at.geometric) <= -light.spread_m || -dot(way, light.normal) <= light.rise_m;
  if (apart != 0) {
    int coarse_count = !behind && squared < reach_squared(light) ? COARSE_SUBLIGHTS : 0;
    return irradiance_of_sublights_apart(at, i, light.area_m2, coarse_count, zone);
  }
  float share = 1.0 - far_share(disk_nearness(squared, light.area_m2), zone);
  return irradiance_of_sublights(at, i, behind ? 0.0 : share, zone);
}

void main() {
  uint slot = group_index();
  if (slot >= head.count) return;
  int tile = int(listed_tiles[slot]);
  ivec2 pixel = ivec2(tile % tiles.x, tile / tiles.x) * NEAR_TILE + ivec2(gl_LocalInvocationID.xy);
  if (any(greaterThanEqual(pixel, textureSize(position_map, 0)))) return;
  vec4 position = texelFetch(position_map, pixel, 0);
  if (position.w == 0.0) return;
  vec4 normals = texelFetch(normal_map, pixel, 0);
  Receiver at = Receiver(position.xyz, octahedral_decode(normals.xy), octahedral_decode(normals.zw));
  vec3 reflected = vec3(0.0), emitted = vec3(0.0);
  for (int word = 0; word < words; ++word) {
    for (uint mask = masks[tile * words + word]; mask != 0u; mask &= mask - 1u) {
      int i = word * 32 + findLSB(mask);
      vec3 irradiance = irradiance_of_light(at, i);
      if (i >= first_emitted) emitted += irradiance;
      else reflected += irradiance;
    }
  }
  vec3 scale = texelFetch(albedo_map, pixel, 0).rgb / PI;
  imageStore(indirect, pixel, vec4(reflected * scale, 1.0));
  if (with_direct != 0) imageStore(direct, pixel, vec4(emitted * scale, 1.0));
}
