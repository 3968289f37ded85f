#version 450 core
// Radiance from irradiance.
#include "screen/base/gbuffer.glsl"
#include "screen/base/smooth_pictures.glsl"
#include "shared/constants.glsl"
#include "shared/group_sizes.shared.h"

layout(local_size_x = SQUARE_GROUP, local_size_y = SQUARE_GROUP) in;
layout(binding = SMOOTH_IRRADIANCE_IMAGE, rgba32f) uniform writeonly image2D radiance[PICTURES];

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, textureSize(albedo_map, 0)))) return;
  vec3 reflectance = texelFetch(albedo_map, pixel, 0).rgb / PI;
  for (int k = 0; k < PICTURES; ++k) imageStore(radiance[k], pixel, vec4(texelFetch(known[k], pixel, 0).rgb * reflectance, 1.0));
}
