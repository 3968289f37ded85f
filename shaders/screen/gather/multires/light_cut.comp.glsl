#version 450 core
// Irradiance of all lights at the pixels of a list. WITH_DIRECT: some of them stand for emission.
#include "screen/base/coarse_pixels.glsl"
#include "screen/base/gbuffer.glsl"
#include "screen/base/slots.shared.h"
#include "screen/gather/multires/light_cut.glsl"
#include "shared/group_sizes.shared.h"

layout(local_size_x = LINEAR_GROUP) in;
layout(std430, binding = PIXEL_LIST_SLOT) readonly buffer PixelList { WorkListHead head; uint listed[]; };
layout(binding = CUT_INDIRECT_IMAGE, rgba32f) uniform writeonly image2D indirect;
#ifdef WITH_DIRECT
layout(binding = CUT_DIRECT_IMAGE, rgba32f) uniform writeonly image2D direct;
#endif

void main() {
  int index = int(global_index());
  if (index >= int(head.count)) return;
  ivec2 pixel = unpack_pixel(listed[index]);
  vec4 normals = texelFetch(normal_map, pixel, 0);
  Irradiance sum = irradiance_of_lights(Receiver(texelFetch(position_map, pixel, 0).xyz, octahedral_decode(normals.xy),
                                                 octahedral_decode(normals.zw)));
  imageStore(indirect, pixel, vec4(sum.reflected, 1.0));
#ifdef WITH_DIRECT
  imageStore(direct, pixel, vec4(sum.emitted, 1.0));
#endif
}
