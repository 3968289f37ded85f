#version 450 core
// The lowest level: leaves by cluster, in their own order. What does not fill a topmost node stays dark.
#include "screen/gather/multires/light_leaves.glsl"

layout(local_size_x = LEAVES_PER_CHUNK) in;
layout(std430, binding = TREE_ROOTS_SLOT) readonly buffer Roots { int first_root[]; };
layout(std430, binding = TREE_NODES_SLOT) writeonly buffer Nodes { LightNode nodes[]; };
shared uint clusters[LEAVES_PER_CHUNK];

void main() {
  int t = int(gl_LocalInvocationIndex);
  int leaf = int(global_index());
  uint cluster = leaf < leaf_count ? cluster_of_leaf[leaf] : NO_CLUSTER;
  clusters[t] = cluster;
  barrier();
  if (cluster == NO_CLUSTER) return;
  int place = chunk_counts[int(group_index()) * cluster_count + int(cluster)];
  for (int s = 0; s < t; ++s) place += clusters[s] == cluster ? 1 : 0;
  LightNode node = leaf_at(leaf);
  node.kind |= int(cluster) << NODE_CLUSTER_SHIFT;
  nodes[first_of_level(0) + (first_root[cluster] << (2 * top_level)) + place] = node;
}
