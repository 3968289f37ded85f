#version 450 core
// Starts a pulse of the papers' schemes: the flux of every side as a cosine lobe about its normal, in the cell that sees
// it. Gaitatzes 2010, section 4: virtual point lights are "hemispherical lights with a cosine falloff".
// Set by the program: ORDER = 2
#include "propagation/pulse_lobes.glsl"
#include "propagation/slots.shared.h"
#include "shared/group_sizes.shared.h"
#include "voxel/cell_sides.glsl"
#include "voxel/grid_block.glsl"
#include "voxel/sides.glsl"

layout(local_size_x = CELL_GROUP_X, local_size_y = CELL_GROUP_Y, local_size_z = CELL_GROUP_Z) in;
layout(binding = NEXT_LOBES_IMAGE, rgba32f) uniform restrict writeonly image3D next_lobes;
layout(std430, binding = SIDE_FLUX_SLOT) readonly buffer SideFlux { vec4 side_flux[]; };  // A B0 [W]

void main() {
  ivec3 c = ivec3(gl_GlobalInvocationID);
  if (!cell_inside(grid, c)) return;
  uvec2 own_sides = cell_sides[cell_index(grid, c)];
  Lobes sum = dark_lobes();
  uint end = own_sides.x + count_bits(own_sides.y & 63u);
  for (uint s = own_sides.x; s < end; ++s) add_lobes(sum, side_flux[s].rgb, cosine_lobe(sides[s].normal));
  STORE_LOBES(next_lobes, c, grid.cells.z, sum);
}
