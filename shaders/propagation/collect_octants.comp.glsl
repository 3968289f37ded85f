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

void main() {
  int i = int(global_index());
  if (i >= int(side_count)) return;
  ivec2 t = side_texel(i) * ivec2(4, 1);
  vec3 sum = (texelFetch(arrived, t, 0).rgb + texelFetch(arrived, t + ivec2(1, 0), 0).rgb) +
             (texelFetch(arrived, t + ivec2(2, 0), 0).rgb + texelFetch(arrived, t + ivec2(3, 0), 0).rgb);
  received[i].rgb += sides[i].coverage * sum;
}
