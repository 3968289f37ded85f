#version 450 core
// Means of how far lobes see, along one axis, over pixels of one surface that ask for the same samples.
#include "screen/gather/area/lobe_samples.glsl"
#include "shared/group_sizes.shared.h"

layout(local_size_x = SQUARE_GROUP, local_size_y = SQUARE_GROUP) in;
layout(binding = AREA_LOBE_KIND_UNIT) uniform usampler2D kinds;
layout(binding = AREA_LOBE_WAYS_UNIT) uniform sampler2D before[3];
layout(binding = AREA_LOBE_WAYS_IMAGE, rgba32f) uniform writeonly image2D ways[3];
uniform ivec2 axis;

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy), size = textureSize(position_map, 0);
  if (any(greaterThanEqual(pixel, size)) || texelFetch(kinds, pixel, 0).r != LOBE_NARROW) return;
  vec3 position = texelFetch(position_map, pixel, 0).xyz;
  vec3 normal = octahedral_decode(texelFetch(normal_map, pixel, 0).xy);
  const float WEIGHTS[3] = float[3](6.0, 4.0, 1.0);
  vec4 sum[3] = vec4[3](vec4(0.0), vec4(0.0), vec4(0.0));
  float all = 0.0;
  for (int k = -2; k <= 2; ++k) {
    ivec2 at = pixel + 2 * k * axis;
    if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, size))) continue;
    if (k != 0 && (texelFetch(kinds, at, 0).r != LOBE_NARROW || !shows_surface(position, normal, at))) continue;
    float weight = WEIGHTS[abs(k)];
    sum[0] += weight * texelFetch(before[0], at, 0);
    sum[1] += weight * texelFetch(before[1], at, 0);
    sum[2] += weight * texelFetch(before[2], at, 0);
    all += weight;
  }
  imageStore(ways[0], pixel, sum[0] / all);
  imageStore(ways[1], pixel, sum[1] / all);
  imageStore(ways[2], pixel, sum[2] / all);
}
