#version 450 core
// Histogram of the error estimates of pixels. Counts are integers: their sum does not depend on the order.
#include "screen/gather/interleaved/exact_pixels.glsl"
#include "screen/gather/interleaved/slots.shared.h"

layout(local_size_x = ERROR_TILE) in;
layout(binding = ERROR_ESTIMATE_IMAGE, r32f) uniform readonly image2D error_estimate;
layout(std430, binding = ERROR_BINS_SLOT) buffer Bins { uint threshold; uint count[]; };
shared uint own[ERROR_BINS];

void main() {
  uint me = gl_LocalInvocationIndex;
  for (uint i = me; i < uint(ERROR_BINS); i += uint(ERROR_TILE)) own[i] = 0u;
  barrier();
  ivec2 size = imageSize(error_estimate);
  for (int row = 0; row < ERROR_TILE; ++row) {
    ivec2 pixel = ivec2(gl_WorkGroupID.xy) * ERROR_TILE + ivec2(me, row);
    if (all(lessThan(pixel, size))) atomicAdd(own[error_bin(imageLoad(error_estimate, pixel).r)], 1u);
  }
  barrier();
  for (uint i = me; i < uint(ERROR_BINS); i += uint(ERROR_TILE)) {
    if (own[i] > 0u) atomicAdd(count[i], own[i]);
  }
}
