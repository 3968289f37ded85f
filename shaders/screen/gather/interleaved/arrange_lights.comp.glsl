#version 450 core
// Lights in the order of their clusters; `source` becomes the area light. Behind them those without one: their source
// is behind every area light.
#include "shared/global_index.shared.h"
#include "screen/visibility/area_maps/virtual_area_light.shared.h"
#include "shared/virtual_light.shared.h"

layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Lights { VirtualLight lights[]; };
layout(std430, binding = 1) readonly buffer Order { uint order[]; };
layout(std430, binding = 2) readonly buffer Clusters { uint cluster_of[]; };
layout(std430, binding = 3) writeonly buffer Arranged { VirtualLight arranged[]; };
uniform int light_count;

void main() {
  int place = int(global_index());
  if (place >= light_count) return;
  uint index = order[place];
  VirtualLight l = lights[index];
  l.source = int(min(cluster_of[index], uint(MAX_VIRTUAL_AREA_LIGHTS)));
  arranged[place] = l;
}
