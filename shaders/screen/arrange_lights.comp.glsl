#version 450 core
// Lights in the order of their clusters, dealt out to subsets: subset j gets the lights j, j + S, j + 2S, ... and the
// subsets lie one after another. `source` becomes the area light.
#include "shared/virtual_light.shared.h"

layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Lights { VirtualLight lights[]; };
layout(std430, binding = 1) readonly buffer Order { uint order[]; };
layout(std430, binding = 2) readonly buffer Clusters { uint cluster_of[]; };
layout(std430, binding = 3) writeonly buffer Arranged { VirtualLight arranged[]; };
uniform int light_count;
uniform int subsets;
uniform int lights_a_subset;

void main() {
  int place = int(gl_GlobalInvocationID.x);
  if (place >= subsets * lights_a_subset) return;
  int position = place % lights_a_subset * subsets + place / lights_a_subset;
  VirtualLight l = VirtualLight(vec3(0.0), 0.0, vec3(0.0), VIRTUAL_LIGHT_REFLECTED, vec3(0.0), 0);
  if (position < light_count) {
    uint index = order[position];
    if (cluster_of[index] < 0xffffffffu) {
      l = lights[index];
      l.source = int(cluster_of[index]);
    }
  }
  arranged[place] = l;
}
