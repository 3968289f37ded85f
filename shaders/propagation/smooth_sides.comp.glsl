#version 450 core
// Single sides of tilted surfaces carry staircase noise of tens of percent: the irradiance that pixels see is the
// mean by side_weight() over the sides with like normals in the 3^3 cells around, clamped at zero afterwards
// (docs/conventions.md#volume-quantities).
#include "propagation/neighbourhood.glsl"
#include "propagation/slots.shared.h"
#include "shared/global_index.shared.h"
#include "shared/group_sizes.shared.h"
#include "voxel/side_count.glsl"
#include "voxel/sides.glsl"

layout(local_size_x = LINEAR_GROUP) in;
layout(std430, binding = WEIGHTED_DIRECT_SLOT) readonly buffer Direct { vec4 direct[]; };
layout(std430, binding = WEIGHTED_INDIRECT_SLOT) readonly buffer Indirect { vec4 indirect[]; };
// Irradiance [W m^-2].
layout(std430, binding = DIRECT_IRRADIANCE_SLOT) writeonly buffer DirectIrradiance { vec4 direct_irradiance[]; };
layout(std430, binding = INDIRECT_IRRADIANCE_SLOT) writeonly buffer IndirectIrradiance { vec4 indirect_irradiance[]; };

void main() {
  uint i = global_index();
  if (i >= side_count) return;
  ivec3 centre = cell_coord(grid, sides[i].cell);
  vec3 normal = sides[i].normal;
  uint reached = reachable_cells(centre);
  vec4 direct_sum = vec4(0.0);
  vec4 indirect_sum = vec4(0.0);
  for (int k = 0; k < 27; ++k) {
    if (((reached >> k) & 1u) == 0u) continue;
    uvec2 own_sides = cell_sides[cell_index(grid, centre + ivec3(k % 3 - 1, (k / 3) % 3 - 1, k / 9 - 1))];
    uint count = count_bits(own_sides.y & 63u);
    for (uint s = own_sides.x; s < own_sides.x + count; ++s) {
      if (dot(sides[s].normal, normal) < SIMILAR_NORMAL_COSINE) continue;
      direct_sum += direct[s];
      indirect_sum += indirect[s];
    }
  }
  direct_irradiance[i] = vec4(max(direct_sum.rgb, vec3(0.0)) / direct_sum.a, 1.0);
  indirect_irradiance[i] = vec4(max(indirect_sum.rgb, vec3(0.0)) / indirect_sum.a, 1.0);
}
