#version 450 core
// Nodes of a level as virtual lights.
#include "screen/gather/multires/light_tree.glsl"
#include "screen/views/slots.shared.h"
#include "shared/global_index.shared.h"
#include "shared/group_sizes.shared.h"
#include "shared/octahedral.glsl"
#include "shared/virtual_light.shared.h"

layout(local_size_x = LINEAR_GROUP) in;
layout(std430, binding = VIEWED_NODES_SLOT) readonly buffer Nodes { LightNode nodes[]; };
layout(std430, binding = LIGHTS_OF_NODES_SLOT) writeonly buffer Lights { VirtualLight lights[]; };
uniform int level;
uniform int count;

void main() {
  int i = int(global_index());
  if (i >= count) return;
  LightNode node = nodes[first_of_level(level) + i];
  vec3 normal = octahedral_decode(unpackSnorm2x16(node.normal));
  lights[i] = VirtualLight(node.position, node.area_m2, normal, node.kind & NODE_KIND_BITS, node.flux,
                           node.kind >> NODE_CLUSTER_SHIFT);
}
