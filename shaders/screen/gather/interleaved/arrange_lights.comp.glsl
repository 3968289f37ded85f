#version 450 core
// Lights in the order of their clusters; `source` becomes the area light. Behind them those without one: their source
// is behind every area light.
#include "shared/global_index.shared.h"
#include "screen/visibility/area_maps/virtual_area_light.shared.h"
#include "screen/visibility/area_maps/light_order.glsl"
#include "screen/gather/interleaved/slots.shared.h"
#include "shared/group_sizes.shared.h"

layout(local_size_x = LINEAR_GROUP) in;
layout(std430, binding = ARRANGED_LIGHTS_SLOT) writeonly buffer Arranged { VirtualLight arranged[]; };
uniform int light_count;

void main() {
  int place = int(global_index());
  if (place >= light_count) return;
  uint index = order[place];
  VirtualLight l = lights[index];
  l.source = int(min(cluster_of[index], uint(MAX_VIRTUAL_AREA_LIGHTS)));
  arranged[place] = l;
}
