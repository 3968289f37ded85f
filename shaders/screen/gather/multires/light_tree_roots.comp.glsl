#version 450 core
// Where every cluster's topmost nodes begin, from how many it has: as many as hold its leaves, cluster after cluster.
#include "screen/gather/multires/light_leaves.glsl"

#define THREADS 64
layout(local_size_x = THREADS) in;
layout(std430, binding = TREE_ROOTS_SLOT) buffer Roots { int first_root[]; };  // one more than clusters
shared int before[THREADS];

void main() {
  int t = int(gl_LocalInvocationIndex);
  int each = (cluster_count + THREADS - 1) / THREADS;
  int first = min(t * each, cluster_count), end = min(first + each, cluster_count);
  int own = 0;
  for (int k = first; k < end; ++k) own += first_root[k];
  before[t] = own;
  barrier();
  int sum = 0;
  for (int s = 0; s < t; ++s) sum += before[s];
  for (int k = first; k < end; ++k) {
    int roots = first_root[k];
    first_root[k] = sum;
    sum += roots;
  }
  if (t == THREADS - 1) first_root[cluster_count] = sum;
}
