#version 450 core
// Every leaf to a cluster, by the distances that clusters are made by: over the scene's diagonal, of normals over pi, and
// off the cluster's plane. Normals weigh more here: what faces another way than the rest opens the nodes over it.
#include "screen/gather/multires/light_leaves.glsl"
#include "screen/visibility/area_maps/area_lights_block.glsl"

layout(local_size_x = LEAVES_PER_CHUNK) in;
uniform float scene_diagonal_m;
shared int own_counts[MAX_VIRTUAL_AREA_LIGHTS];

uint nearest_cluster(LightNode leaf) {
  vec3 normal = normal_of(leaf);
  uint nearest = NO_CLUSTER;
  float smallest = 3.0e38;
  for (int k = 0; k < cluster_count; ++k) {
    vec3 way = leaf.position - area_lights[k].position;
    float turn = 1.0 - dot(normal, area_lights[k].normal);
    float distance_m = 0.7 * length(way) + 2.0 * abs(dot(way, area_lights[k].normal));
    float d = distance_m / scene_diagonal_m + turn;
    if (area_lights[k].light_count > 0 && d < smallest) {
      smallest = d;
      nearest = uint(k);
    }
  }
  return nearest;
}

void main() {
  if (int(group_index()) * LEAVES_PER_CHUNK >= leaf_count) return;  // of a whole group
  int t = int(gl_LocalInvocationIndex);
  for (int k = t; k < cluster_count; k += LEAVES_PER_CHUNK) own_counts[k] = 0;
  barrier();
  int leaf = int(global_index());
  uint cluster = NO_CLUSTER;
  if (leaf < leaf_count) {
    LightNode node = leaf_at(leaf);
    if (weight_of(node) > 0.0) cluster = nearest_cluster(node);
    cluster_of_leaf[leaf] = cluster;
  }
  if (cluster != NO_CLUSTER) atomicAdd(own_counts[cluster], 1);
  barrier();
  int first = int(group_index()) * cluster_count;
  for (int k = t; k < cluster_count; k += LEAVES_PER_CHUNK) chunk_counts[first + k] = own_counts[k];
}
