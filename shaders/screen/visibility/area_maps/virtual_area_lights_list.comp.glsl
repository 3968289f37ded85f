#version 450 core
// Lists every cluster's lights in their own order, cluster after cluster; behind all the lights without flux. One work
// group a list.
#include "screen/visibility/area_maps/virtual_area_lights.glsl"

#define THREADS 64
layout(local_size_x = THREADS) in;
layout(std430, binding = MADE_AREA_LIGHTS_SLOT) writeonly buffer AreaLights { VirtualAreaLight area_lights[]; };
layout(std430, binding = MADE_ORDER_SLOT) writeonly buffer Order { uint order[]; };
uniform int cluster_count;
shared ivec2 before[THREADS];

void main() {
  int t = int(gl_LocalInvocationIndex);
  int cluster = int(gl_WorkGroupID.x);
  uint wanted = cluster < cluster_count ? uint(cluster) : NO_VIRTUAL_AREA_LIGHT;
  int each = (light_count + THREADS - 1) / THREADS;
  int first = min(t * each, light_count);
  int end = min(first + each, light_count);
  ivec2 found = ivec2(0);  // lights of clusters before this one, and its own
  for (int i = first; i < end; ++i) {
    uint c = cluster_of[i];
    found += ivec2(c < wanted, c == wanted);
  }
  before[t] = found;
  barrier();
  if (t == 0) {
    ivec2 sum = ivec2(0);
    for (int s = 0; s < THREADS; ++s) {
      ivec2 own = before[s];
      before[s] = sum;
      sum += own;
    }
    for (int s = 0; s < THREADS; ++s) before[s].y += sum.x;
    if (cluster < cluster_count) {
      area_lights[cluster].first_light = sum.x;
      area_lights[cluster].light_count = sum.y;
    }
  }
  barrier();
  int at = before[t].y;
  for (int i = first; i < end; ++i) {
    if (cluster_of[i] == wanted) order[at++] = uint(i);
  }
}
