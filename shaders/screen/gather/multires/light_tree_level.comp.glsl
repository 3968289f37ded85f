#version 450 core
// A level over that of the leaves, from the one below it.
#include "screen/gather/multires/light_node_sum.glsl"
#include "shared/global_index.shared.h"
#include "shared/group_sizes.shared.h"

layout(local_size_x = LINEAR_GROUP) in;
layout(std430, binding = TREE_ROOTS_SLOT) readonly buffer Roots { int first_root[]; };
layout(std430, binding = TREE_NODES_SLOT) buffer Nodes { LightNode nodes[]; };
uniform int level;
uniform int cluster_count;

void main() {
  int i = int(global_index());
  if (i >= first_root[cluster_count] << (2 * (top_level - level))) return;
  int first_part = first_of_level(level - 1) + 4 * i;
  LightNode parts[4];
  for (int k = 0; k < 4; ++k) parts[k] = nodes[first_part + k];
  nodes[first_of_level(level) + i] = sum_of_nodes(parts);
}
