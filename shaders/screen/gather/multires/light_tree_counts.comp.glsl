#version 450 core
// Where every cluster's leaves of every chunk go in the cluster, and how many topmost nodes hold all of them. One
// invocation a cluster: software rasterizers end an invocation's loops after 65535 rounds in all.
#include "screen/gather/multires/light_leaves.glsl"
#include "shared/group_sizes.shared.h"

layout(local_size_x = LINEAR_GROUP) in;
layout(std430, binding = TREE_ROOTS_SLOT) buffer Roots { int first_root[]; };

void main() {
  int k = int(global_index());
  if (k >= cluster_count) return;
  int chunks = (leaf_count + LEAVES_PER_CHUNK - 1) / LEAVES_PER_CHUNK;
  int per_root = 1 << (2 * top_level);
  int leaves = 0;
  for (int c = 0; c < chunks; ++c) {
    int here = chunk_counts[c * cluster_count + k];
    chunk_counts[c * cluster_count + k] = leaves;
    leaves += here;
  }
  first_root[k] = (leaves + per_root - 1) / per_root;
}
