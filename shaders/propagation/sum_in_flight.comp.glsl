#version 450 core
// Power still in flight in the volume, per band: 64 partial sums by 64 groups (sum_partials adds them). A stored lobe's
// clamped face powers sum to the power that it carries; the first number of a pulse's lobe (papers' schemes) is its power.
// Set by the program: ORDER = 2
// Set by the program: PULSE = 0
#include "propagation/crossing.glsl"
#include "propagation/partial_sums.shared.h"
#include "propagation/slots.shared.h"
#include "voxel/grid_block.glsl"

layout(local_size_x = 256) in;
layout(binding = LOBES_UNIT) uniform sampler3D lobes;
layout(std430, binding = PARTIALS_SLOT) writeonly buffer Partials { vec4 partials[]; };

shared vec4 running[256];

void main() {
  uint lane = gl_LocalInvocationID.x;
  int cells = grid.cells.x * grid.cells.y * grid.cells.z;
  vec4 sum = vec4(0.0);
  for (int i = int(gl_GlobalInvocationID.x); i < cells; i += PARTIAL_SUMS * 256) {
    Lobes own = load_lobes(lobes, cell_coord(grid, i), grid.cells.z);
#if PULSE
    sum.rgb += lobe_powers(own);
#else
    for (int face = 0; face < 6; ++face) sum.rgb += hit_power(own, face);
#endif
  }
  running[lane] = sum;
  barrier();
  for (uint half_count = 128u; half_count > 0u; half_count >>= 1) {
    if (lane < half_count) running[lane] += running[lane + half_count];
    barrier();
  }
  if (lane == 0u) partials[gl_WorkGroupID.x] = running[0];
}
