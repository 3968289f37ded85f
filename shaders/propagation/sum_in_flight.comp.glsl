#version 450 core
// Power still in flight in the volume, per band: 64 partial sums by 64 groups (sum_partials adds them). A stored lobe's
// clamped face powers sum to the power that it carries.
#include "shared/grid.shared.h"
#include "shared/sh.shared.h"

layout(local_size_x = 256) in;
layout(std140, binding = 0) uniform GridBlock { Grid grid; };
layout(binding = 0) uniform sampler3D lobes;
layout(std430, binding = 10) writeonly buffer Partials { vec4 partials[]; };

shared vec4 running[256];

float carried(vec4 lobe) {
  float power = 0.0;
  for (int face = 0; face < 6; ++face) power += max(pyramid_power(lobe, face), 0.0);
  return power;
}

void main() {
  uint lane = gl_LocalInvocationID.x;
  int cells = grid.cells.x * grid.cells.y * grid.cells.z;
  vec4 sum = vec4(0.0);
  for (int i = int(gl_GlobalInvocationID.x); i < cells; i += 64 * 256) {
    ivec3 c = cell_coord(grid, i);
    sum.r += carried(texelFetch(lobes, c, 0));
    sum.g += carried(texelFetch(lobes, c + ivec3(0, 0, grid.cells.z), 0));
    sum.b += carried(texelFetch(lobes, c + ivec3(0, 0, 2 * grid.cells.z), 0));
  }
  running[lane] = sum;
  barrier();
  for (uint half_count = 128u; half_count > 0u; half_count >>= 1) {
    if (lane < half_count) running[lane] += running[lane + half_count];
    barrier();
  }
  if (lane == 0u) partials[gl_WorkGroupID.x] = running[0];
}
