#version 450 core
// Irradiance at the pixels of a list, of which each has asked for a share of every group: the mean over the pixels
// around it that show its surface, by weights 1 2 1 along both axes, in which each share has the same part.
#include "screen/base/coarse_pixels.glsl"
#include "screen/gather/area/area_level.glsl"
#include "shared/group_sizes.shared.h"

layout(local_size_x = LINEAR_GROUP) in;
layout(binding = AREA_IRRADIANCE_IMAGE, rgba32f) uniform writeonly image2D irradiance;
layout(binding = AREA_SHARED_UNIT) uniform sampler2D shared_irradiance;
layout(binding = AREA_STEP_UNIT) uniform usampler2D gathered_step;
layout(std430, binding = AREA_LIST_SLOT) readonly buffer PixelList { WorkListHead head; uint listed[]; };

vec3 irradiance_at(ivec2 at) {
  return int(texelFetch(gathered_step, at, 0).r) == step_px ? texelFetch(shared_irradiance, at, 0).rgb
                                                            : texelFetch(known_irradiance, at, 0).rgb;
}

void main() {
  int index = int(global_index());
  if (index >= int(head.count)) return;
  ivec2 pixel = unpack_pixel(listed[index]), size = textureSize(position_map, 0);
  vec3 position = texelFetch(position_map, pixel, 0).xyz;
  vec3 normal = octahedral_decode(texelFetch(normal_map, pixel, 0).xy);
  vec4 sum = 4.0 * vec4(irradiance_at(pixel), 1.0);
  for (int k = 0; k < 9; ++k) {
    ivec2 off = ivec2(k % 3, k / 3) - 1, at = pixel + off * step_px;
    if (off == ivec2(0) || any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, size))) continue;
    if (!shows_surface(position, normal, at)) continue;
    sum += float((2 - abs(off.x)) * (2 - abs(off.y))) * vec4(irradiance_at(at), 1.0);
  }
  imageStore(irradiance, pixel, vec4(sum.rgb / sum.w, 1.0));
}
