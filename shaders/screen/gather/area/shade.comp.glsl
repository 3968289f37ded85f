#version 450 core
// Radiance from irradiance.
#include "screen/base/gbuffer.glsl"
#include "screen/gather/area/slots.shared.h"
#include "shared/constants.glsl"
#include "shared/group_sizes.shared.h"

layout(local_size_x = SQUARE_GROUP, local_size_y = SQUARE_GROUP) in;
layout(binding = AREA_IRRADIANCE_UNIT) uniform sampler2D irradiance;
layout(binding = AREA_RADIANCE_IMAGE, rgba32f) uniform writeonly image2D radiance;

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, textureSize(albedo_map, 0)))) return;
  vec3 reflectance = texelFetch(albedo_map, pixel, 0).rgb / PI;
  imageStore(radiance, pixel, vec4(reflectance * texelFetch(irradiance, pixel, 0).rgb, 1.0));
}
