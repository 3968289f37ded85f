#version 450 core
// Mean over a window as wide as a block of interleaved pixels, along one axis, of pixels on the same surface: Dong et
// al. 2009, section 6; Laine et al. 2007. The window's ends count half, so that every place in the block counts once.
// The second axis ends in radiance.
#include "shared/octahedral.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D position_map;
layout(binding = 1) uniform sampler2D normal_map;
layout(binding = 2) uniform sampler2D albedo_map;
layout(binding = 3) uniform sampler2D irradiance;
layout(binding = 0, rgba32f) uniform writeonly image2D blurred;
uniform int interleave;
uniform ivec2 axis;
uniform float most_distance_m;
uniform float least_cosine;
uniform float off_plane;
uniform int ends;

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  ivec2 size = textureSize(position_map, 0);
  if (any(greaterThanEqual(pixel, size))) return;
  vec4 position = texelFetch(position_map, pixel, 0);
  if (position.w == 0.0) {
    imageStore(blurred, pixel, vec4(0.0));
    return;
  }
  vec3 normal = octahedral_decode(texelFetch(normal_map, pixel, 0).xy);
  vec4 sum = vec4(0.0);
  for (int i = -interleave / 2; i <= interleave / 2; ++i) {
    ivec2 at = pixel + i * axis;
    if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, size))) continue;
    vec4 there = texelFetch(position_map, at, 0);
    vec3 way = there.xyz - position.xyz;
    float squared = dot(way, way);
    float height = dot(way, normal);
    if (there.w == 0.0 || squared > most_distance_m * most_distance_m ||
        height * height > off_plane * off_plane * squared) continue;
    if (dot(octahedral_decode(texelFetch(normal_map, at, 0).xy), normal) < least_cosine) continue;
    float weight = abs(i) * 2 == interleave ? 0.5 : 1.0;
    sum += weight * vec4(texelFetch(irradiance, at, 0).rgb, 1.0);
  }
  vec3 mean = sum.rgb / sum.w;
  if (ends != 0) mean *= texelFetch(albedo_map, pixel, 0).rgb / 3.14159265358979;
  imageStore(blurred, pixel, vec4(mean, 1.0));
}
