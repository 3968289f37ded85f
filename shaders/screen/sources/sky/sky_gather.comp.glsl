#version 450 core
// Irradiance straight from the sky at the pixels of a list, added up over subsets of the sky's parts.
#include "screen/base/coarse_pixels.glsl"
#include "screen/base/gbuffer.glsl"
#include "screen/base/slots.shared.h"
#include "screen/sources/sky/sky_parts.glsl"
#include "shared/group_sizes.shared.h"

layout(local_size_x = LINEAR_GROUP) in;
layout(std430, binding = PIXEL_LIST_SLOT) readonly buffer PixelList { WorkListHead head; uint listed[]; };
layout(binding = SKY_IRRADIANCE_IMAGE, rgba32f) uniform image2D irradiance;
uniform int subset;
uniform int subsets;
uniform int takers;   // 2: pixels beside one another on the grid share the parts
uniform int step_px;  // of that grid

void main() {
  int index = int(global_index());
  if (index >= int(head.count)) return;
  ivec2 pixel = unpack_pixel(listed[index]);
  vec4 normals = texelFetch(normal_map, pixel, 0);
  // New pixels of a grid are odd along one axis or both: what lies two steps off is beside them as well.
  ivec2 at = pixel / step_px;
  int taker = (at.x ^ at.y ^ at.x >> 1 ^ at.y >> 1) & (takers - 1);
  int first = subset * takers + taker;
  vec3 sum = float(takers) * sky_irradiance(first, subsets * takers, texelFetch(position_map, pixel, 0).xyz,
                                            octahedral_decode(normals.xy), octahedral_decode(normals.zw));
  if (subset > 0) sum += imageLoad(irradiance, pixel).rgb;
  imageStore(irradiance, pixel, vec4(sum, 1.0));
}
