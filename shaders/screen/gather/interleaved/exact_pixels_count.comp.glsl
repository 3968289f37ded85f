#version 450 core
// Histogram of the error estimates of pixels. Counts are integers: their sum does not depend on the order.
#include "screen/gather/interleaved/exact_pixels.glsl"

layout(local_size_x = 64) in;
layout(binding = 0, r32f) uniform readonly image2D error_estimate;
layout(std430, binding = 1) buffer Bins { uint threshold; uint count[]; };
shared uint own[ERROR_BINS];

void main() {
  uint me = gl_LocalInvocationIndex;
  for (uint i = me; i < uint(ERROR_BINS); i += 64u) own[i] = 0u;
  barrier();
  ivec2 size = imageSize(error_estimate);
  for (int row = 0; row < 64; ++row) {  // a tile of 64 x 64
    ivec2 pixel = ivec2(gl_WorkGroupID.xy) * 64 + ivec2(me, row);
    if (all(lessThan(pixel, size))) atomicAdd(own[error_bin(imageLoad(error_estimate, pixel).r)], 1u);
  }
  barrier();
  for (uint i = me; i < uint(ERROR_BINS); i += 64u) {
    if (own[i] > 0u) atomicAdd(count[i], own[i]);
  }
}
