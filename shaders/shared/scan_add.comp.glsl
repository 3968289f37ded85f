#version 450 core
// Adds to each number the sum of the blocks before its own (core/gl/scan.h).
#include "shared/scan.shared.h"
#include "shared/global_index.shared.h"

layout(local_size_x = SCAN_BLOCK) in;
layout(std430, binding = 0) buffer Numbers { uint numbers[]; };
layout(std430, binding = 1) readonly buffer BlockSums { uint block_sums[]; };
uniform uint count;

void main() {
  uint i = global_index();
  if (i < count) numbers[i] += block_sums[group_index()];
}
