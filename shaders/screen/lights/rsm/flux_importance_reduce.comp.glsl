#version 450 core
// Makes one level of the pyramid of reflected light from the one below.
#include "screen/lights/rsm/flux_importance.glsl"
#include "screen/lights/rsm/slots.shared.h"
#include "shared/group_sizes.shared.h"

layout(local_size_x = SQUARE_GROUP, local_size_y = SQUARE_GROUP) in;
layout(std430, binding = FLUX_PYRAMID_SLOT) buffer Pyramid { float pyramid[]; };
uniform int resolution;
uniform int layer_count;
uniform int level;  // to make, from 2

void main() {
  int below = level_size(resolution, level - 1);
  int size = (below + 3) / 4;
  ivec3 block = ivec3(gl_GlobalInvocationID);
  if (block.x >= size || block.y >= size) return;
  int from = level_start(resolution, layer_count, level - 1) + block.z * below * below;
  float sum = 0.0;
  for (int k = 0; k < 16; ++k) {
    ivec2 child = 4 * block.xy + ivec2(k & 3, k >> 2);
    if (max(child.x, child.y) < below) sum += pyramid[from + child.y * below + child.x];
  }
  pyramid[level_start(resolution, layer_count, level) + (block.z * size + block.y) * size + block.x] = sum;
}
