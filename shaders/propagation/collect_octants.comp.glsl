#version 450 core
// Adds what the four octants that reach a side have brought to its face (sweep.comp.glsl) to what it has received.
#include "propagation/slots.shared.h"
#include "shared/global_index.shared.h"
#include "propagation/side_texel.glsl"
#include "shared/group_sizes.shared.h"
#include "voxel/side_count.glsl"
#include "voxel/sides.glsl"

layout(local_size_x = LINEAR_GROUP) in;
layout(std430, binding = RECEIVED_SLOT) buffer Received { vec4 received[]; };
layout(binding = ARRIVED_UNIT) uniform sampler2D arrived;
uniform int lanes;  // of an octant: three bands of as many quads of directions

float power_of_band(int side, int band) {
  int quads = lanes / 3;
  float sum = 0.0;
  for (int entry = 0; entry < 4; ++entry) {
    for (int quad = 0; quad < quads; ++quad)
      sum += texelFetch(arrived, arrived_texel(side, entry, band * quads + quad, lanes), 0).r;
  }
  return sum;
}

void main() {
  int i = int(global_index());
  if (i >= int(side_count)) return;
  received[i].rgb += sides[i].coverage * vec3(power_of_band(i, 0), power_of_band(i, 1), power_of_band(i, 2));
}
