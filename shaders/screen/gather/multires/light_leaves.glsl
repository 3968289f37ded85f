// What the light tree is made of: sub-lights, or virtual lights that have none. Chunks of them keep their order while
// they are sorted by cluster.
#ifndef VOLGI_LIGHT_LEAVES_GLSL
#define VOLGI_LIGHT_LEAVES_GLSL
#include "screen/base/virtual_lights.glsl"
#include "screen/gather/multires/light_node_sum.glsl"
#include "screen/gather/multires/light_tree.glsl"
#include "shared/global_index.shared.h"
#include "shared/near_light.shared.h"

#define LEAVES_PER_CHUNK 64  // a work group
#define NO_CLUSTER 0xffffffffu

layout(std430, binding = TREE_SUBLIGHTS_SLOT) readonly buffer SubLights { SubLight sublights[]; };
layout(std430, binding = TREE_LEAF_CLUSTERS_SLOT) buffer LeafClusters { uint cluster_of_leaf[]; };
// Of each chunk, how many leaves every cluster has in it; then, in chunks before it.
layout(std430, binding = TREE_CHUNK_COUNTS_SLOT) buffer ChunkCounts { int chunk_counts[]; };
uniform int leaf_count;
uniform int in_parts;  // 0: lights have no sub-lights
uniform int cluster_count;

LightNode leaf_at(int leaf) {
  if (in_parts == 0) {
    VirtualLight l = lights[leaf];
    return node_of_disk(l.position, l.area_m2, l.flux, packSnorm2x16(octahedral_encode(l.normal)), l.kind);
  }
  int light = leaf / FINE_SUBLIGHTS;
  SubLight s = sublights[light * SUBLIGHTS_PER_LIGHT + COARSE_SUBLIGHTS + leaf % FINE_SUBLIGHTS];
  return node_of_disk(s.position, s.area_m2, s.flux, s.normal, lights[light].kind);
}

#endif
