#version 450 core
// Irradiance straight from the sky. Every interleave-th pixel in both directions takes one subset of the sky's parts,
// times the number of subsets; LISTED: the pixels of a list take all, and the sum ends in radiance.
#include "screen/base/gbuffer.glsl"
#include "screen/base/slots.shared.h"
#include "screen/base/coarse_pixels.glsl"
#include "screen/sources/sky/sky_parts.glsl"
#include "shared/constants.glsl"
#include "shared/global_index.shared.h"
#include "shared/group_sizes.shared.h"

#ifdef LISTED
layout(local_size_x = LINEAR_GROUP) in;
layout(std430, binding = PIXEL_LIST_SLOT) readonly buffer PixelList { WorkListHead head; uint listed[]; };
#else
layout(local_size_x = SQUARE_GROUP, local_size_y = SQUARE_GROUP) in;
#endif
layout(binding = SKY_IRRADIANCE_IMAGE, rgba32f) uniform writeonly image2D irradiance;
uniform int subset;
uniform int interleave;
uniform ivec2 offset;  // of the pixels in their blocks

void main() {
#ifdef LISTED
  int index = int(global_index());
  if (index >= int(head.count)) return;
  ivec2 pixel = unpack_pixel(listed[index]);
#else
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy) * interleave + offset;
  if (any(greaterThanEqual(pixel, textureSize(position_map, 0)))) return;
#endif
  vec4 position = texelFetch(position_map, pixel, 0);
  vec3 sum = vec3(0.0);
  if (position.w != 0.0) {
    vec4 normals = texelFetch(normal_map, pixel, 0);
    int subsets = interleave * interleave;
    sum = sky_irradiance(subset, subsets, position.xyz, octahedral_decode(normals.xy),
                         octahedral_decode(normals.zw));
    sum *= interleave == 1 ? texelFetch(albedo_map, pixel, 0).rgb / PI : vec3(subsets);
  }
  imageStore(irradiance, pixel, vec4(sum, 1.0));
}
