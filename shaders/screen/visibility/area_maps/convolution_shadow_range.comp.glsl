#version 450 core
// The farthest that each layer of paraboloid depth maps sees, one group a layer.
#include "screen/visibility/area_maps/slots.shared.h"

layout(local_size_x = 256) in;
layout(binding = DISTANCE_MAP_UNIT) uniform sampler2DArray distance_map;
layout(binding = FARTHEST_IMAGE, r32f) writeonly uniform image2D farthest;

shared float largest[256];

void main() {
  int layer = int(gl_WorkGroupID.x);
  int resolution = textureSize(distance_map, 0).x;
  uint me = gl_LocalInvocationIndex;
  float found = 0.0;
  for (int i = int(me); i < resolution * resolution; i += 256) {
    float distance_m = texelFetch(distance_map, ivec3(i % resolution, i / resolution, layer), 0).r;
    if (!isinf(distance_m)) found = max(found, distance_m);
  }
  largest[me] = found;
  for (uint half_count = 128u; half_count > 0u; half_count /= 2u) {
    barrier();
    if (me < half_count) largest[me] = max(largest[me], largest[me + half_count]);
  }
  // Where nothing is seen, receivers are nearer than everything.
  if (me == 0u) imageStore(farthest, ivec2(layer, 0), vec4(largest[0] > 0.0 ? largest[0] : 1e30));
}
