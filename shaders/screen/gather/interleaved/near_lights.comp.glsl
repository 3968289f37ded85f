#version 450 core
// Light of the pieces of virtual lights on the pixels near them.
#include "shared/disk_to_point.glsl"
#include "screen/base/gbuffer.glsl"
#include "shared/octahedral.glsl"
#include "screen/gather/interleaved/near_lights.glsl"

layout(local_size_x = NEAR_TILE, local_size_y = NEAR_TILE) in;
layout(std430, binding = 3) readonly buffer Pieces { LightPiece pieces[]; };
layout(binding = 0, rgba32f) writeonly uniform image2D indirect;
layout(binding = 1, rgba32f) writeonly uniform image2D direct;
uniform int first_emitted;
uniform int with_direct;

struct Receiver {
  vec3 position, normal, geometric;
};

// Irradiance from piece p; `form` as far_share() takes it.
vec3 irradiance_of(Receiver at, int p, out float form) {
  vec3 w = pieces[p].position - at.position;
  float squared = dot(w, w);
  form = disk_form(squared, pieces[p].area_m2);
  float cosines = max(dot(w, at.normal), 0.0) * max(-dot(w, octahedral_decode(unpackSnorm2x16(pieces[p].normal))), 0.0);
  cosines = dot(w, at.geometric) > 0.0 ? cosines : 0.0;
  return pieces[p].flux * (cosines * form / (squared * squared + 1e-30));
}

vec3 irradiance_of_quarter(Receiver at, int light, int quarter) {
  float form;
  int first = light * LIGHT_PIECES;
  vec3 whole = irradiance_of(at, first + quarter, form);
  float far = far_share(form, zone);
  if (far >= 1.0) return whole;
  vec3 sum = vec3(0.0);
  for (int k = 0; k < LIGHT_PARTS / LIGHT_QUARTERS; ++k) {
    float unused_form;
    sum += irradiance_of(at, first + LIGHT_QUARTERS + quarter * (LIGHT_PARTS / LIGHT_QUARTERS) + k, unused_form);
  }
  return mix(sum, whole, far);
}

vec3 irradiance_of_light(Receiver at, int i) {
  NearLight light = near_lights[i];
  vec3 way = light.position - at.position;
  float squared = dot(way, way);
  float share = 1.0 - far_share(disk_form(squared, light.area_m2), zone);
  bool behind = dot(way, at.geometric) <= -light.spread_m || -dot(way, light.normal) <= light.rise_m;
  if (share <= 0.0 || behind) return vec3(0.0);
  vec3 sum = vec3(0.0);
  for (int quarter = 0; quarter < LIGHT_QUARTERS; ++quarter) sum += irradiance_of_quarter(at, i, quarter);
  return share * sum;
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
