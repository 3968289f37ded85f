#version 450 core
// Adds what the four octants that reach a side have brought to its face (sweep.comp.glsl) to what it has received.
#include "shared/global_index.shared.h"
#include "shared/side.shared.h"
#include "propagation/side_texel.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = 4) readonly buffer Sides { Side sides[]; };
layout(std430, binding = 5) readonly buffer SideCount { uint side_count; };
layout(std430, binding = 6) buffer Received { vec4 received[]; };
layout(binding = 0) uniform sampler2D arrived;
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
