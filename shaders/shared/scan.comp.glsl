#version 450 core
// Each number becomes the sum of those before it in its block; blocks' sums go to a list of their own (core/gl/scan.h).
#include "shared/scan.shared.h"
#include "shared/global_index.shared.h"
#define SCAN_GROUP uint(SCAN_BLOCK)
#include "shared/scan.glsl"

layout(local_size_x = SCAN_BLOCK) in;
layout(std430, binding = SCAN_NUMBERS_SLOT) buffer Numbers { uint numbers[]; };
layout(std430, binding = SCAN_BLOCK_SUMS_SLOT) writeonly buffer BlockSums { uint block_sums[]; };
uniform uint count;

void main() {
  uint i = global_index();
  uint own = i < count ? numbers[i] : 0u;
  uint before = sum_before(own);
  if (i < count) numbers[i] = before;
  if (gl_LocalInvocationIndex == SCAN_GROUP - 1u && group_index() * SCAN_GROUP < count)
    block_sums[group_index()] = before + own;
}
