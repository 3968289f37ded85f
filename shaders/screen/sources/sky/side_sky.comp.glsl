#version 450 core
// What every side reflects of light straight from the sky: A rho E [W].
#include "screen/sources/sky/sky_parts.glsl"
#include "shared/global_index.shared.h"
#include "shared/group_sizes.shared.h"
#include "voxel/grid_block.glsl"
#include "voxel/side_count.glsl"
#include "voxel/side_middle.glsl"
#include "voxel/sides.glsl"

layout(local_size_x = LINEAR_GROUP) in;
layout(std430, binding = SKY_FLUX_SLOT) buffer Flux { vec4 flux[]; };
uniform int stride;
uniform int sample_index;  // of the pictures that are averaged

// As first_part_of_side() of propagation/light_in/side_sky_cpu.h.
int first_of_side(ivec3 cell, int face) {
  uint place = 3518319155u * uint(cell.x) + 2882110345u * uint(cell.y) + 2360945575u * uint(cell.z) +
               2654435769u * uint(face);
  uint high, low;
  umulExtended(place, uint(stride), high, low);
  return int(high);
}

void main() {
  uint s = global_index();
  if (s >= side_count || s >= uint(sides.length())) return;
  Side side = sides[s];
  // Beside its surface by what vertices are rounded to, or a side would hide the sky from itself.
  vec3 position = world_from_cell(grid, middle_of(side)) + side.normal * (grid.cell_size_m * 2.0 / float(SLICE_STEPS));
  int first = (first_of_side(cell_coord(grid, side.cell), side.face) + sample_index) % stride;
  vec3 e = sky_irradiance(first, stride, position, side.normal, side.normal) * float(stride);
  flux[s] += vec4(side.albedo * side.area_m2 * e, 0.0);
}
