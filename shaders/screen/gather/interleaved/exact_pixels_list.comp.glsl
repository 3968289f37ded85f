#version 450 core
// Lists the pixels with the largest error estimates.
#include "screen/base/coarse_pixels.glsl"
#include "screen/gather/interleaved/exact_pixels.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0, r32f) uniform readonly image2D error_estimate;
layout(std430, binding = 0) buffer PixelList { WorkListHead head; uint listed[]; };
layout(std430, binding = 1) readonly buffer Bins { uint threshold; uint count[]; };

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, imageSize(error_estimate))) || error_bin(imageLoad(error_estimate, pixel).r) < threshold) return;
  uint slot;
  APPEND_TO_LIST(head, 64u, slot)
  listed[slot] = pack_pixel(pixel);
}
