#version 450 core
// Lists the pixels with the largest error estimates.
#include "screen/base/coarse_pixels.glsl"
#include "screen/base/slots.shared.h"
#include "screen/gather/interleaved/exact_pixels.glsl"
#include "screen/gather/interleaved/slots.shared.h"
#include "shared/group_sizes.shared.h"

layout(local_size_x = SQUARE_GROUP, local_size_y = SQUARE_GROUP) in;
layout(binding = ERROR_ESTIMATE_IMAGE, r32f) uniform readonly image2D error_estimate;
layout(std430, binding = PIXEL_LIST_SLOT) buffer PixelList { WorkListHead head; uint listed[]; };
layout(std430, binding = ERROR_BINS_SLOT) readonly buffer Bins { uint threshold; uint count[]; };

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, imageSize(error_estimate))) || error_bin(imageLoad(error_estimate, pixel).r) < threshold) return;
  uint slot;
  APPEND_TO_LIST(head, uint(LINEAR_GROUP), slot)
  listed[slot] = pack_pixel(pixel);
}
