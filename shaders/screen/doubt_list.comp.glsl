#version 450 core
// Lists the pixels in most doubt.
#include "screen/coarse_pixels.glsl"
#include "screen/doubt_bins.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0, r32f) uniform readonly image2D doubt;
layout(std430, binding = 0) buffer PixelList { PixelListHead head; uint listed[]; };
layout(std430, binding = 1) readonly buffer Bins { uint threshold; uint count[]; };

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, imageSize(doubt))) || doubt_bin(imageLoad(doubt, pixel).r) < threshold) return;
  uint slot = atomicAdd(head.count, 1u);
  if (slot % 64u == 0u) {
    uint group = slot / 64u;
    if (group < GROUPS_A_ROW) atomicAdd(head.groups_x, 1u);
    else if (group % GROUPS_A_ROW == 0u) atomicAdd(head.groups_y, 1u);
  }
  listed[slot] = pack_pixel(pixel);
}
