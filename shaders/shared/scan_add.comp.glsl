#version 450 core
// Adds to each number the sum of the blocks before its own (core/gl/scan.h).
#include "shared/scan.shared.h"
#include "shared/global_index.shared.h"

layout(local_size_x = SCAN_BLOCK) in;
layout(std430, binding = SCAN_NUMBERS_SLOT) buffer Numbers { uint numbers[]; };
layout(std430, binding = SCAN_BLOCK_SUMS_SLOT) readonly buffer BlockSums { uint block_sums[]; };
uniform uint count;

void main() {
  uint i = global_index();
  if (i < count) numbers[i] += block_sums[group_index()];
}
