#version 450 core
// The volume's irradiance at the pixels of a list. WITH_DIRECT: first arrivals have a picture of their own.
#include "screen/base/coarse_pixels.glsl"
#include "screen/base/slots.shared.h"
#include "screen/bounces/volume/slots.shared.h"
#include "screen/bounces/volume/volume_gather.glsl"
#include "shared/group_sizes.shared.h"

layout(local_size_x = LINEAR_GROUP) in;
layout(std430, binding = PIXEL_LIST_SLOT) readonly buffer PixelList { WorkListHead head; uint listed[]; };
layout(binding = GATHERED_INDIRECT_IMAGE, rgba32f) uniform writeonly image2D indirect;
#ifdef WITH_DIRECT
layout(binding = GATHERED_DIRECT_IMAGE, rgba32f) uniform writeonly image2D direct;
#endif

void main() {
  int index = int(global_index());
  if (index >= int(head.count)) return;
  ivec2 pixel = unpack_pixel(listed[index]);
  Gathered g = gather_pixel(texelFetch(position_map, pixel, 0).xyz,
                            octahedral_decode(texelFetch(normal_map, pixel, 0).zw));  // geometric
  float over_weight = g.weight > 0.0 ? 1.0 / g.weight : 0.0;
  imageStore(indirect, pixel, vec4(g.indirect * over_weight, 1.0));
#ifdef WITH_DIRECT
  imageStore(direct, pixel, vec4(g.direct * over_weight, 1.0));
#endif
}
