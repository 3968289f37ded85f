#version 450 core
// Starts a pulse of the papers' schemes: the flux of every side as a cosine lobe about its normal, in the cell that sees
// it. Gaitatzes 2010, section 4: virtual point lights are "hemispherical lights with a cosine falloff".
// Set by the program: ORDER = 2
#include "shared/grid.shared.h"
#include "shared/side.shared.h"
#include "propagation/pulse_lobes.glsl"

layout(local_size_x = 8, local_size_y = 8, local_size_z = 4) in;
layout(std140, binding = 0) uniform GridBlock { Grid grid; };
layout(binding = 0, rgba32f) uniform restrict writeonly image3D next_lobes;
layout(std430, binding = 3) readonly buffer CellSides { uvec2 cell_sides[]; };
layout(std430, binding = 4) readonly buffer Sides { Side sides[]; };
layout(std430, binding = 7) readonly buffer SideFlux { vec4 side_flux[]; };  // A B0 [W]

void main() {
  ivec3 c = ivec3(gl_GlobalInvocationID);
  if (!cell_inside(grid, c)) return;
  uvec2 own_sides = cell_sides[cell_index(grid, c)];
  Lobes sum = dark_lobes();
  uint end = own_sides.x + count_bits(own_sides.y & 63u);
  for (uint s = own_sides.x; s < end; ++s) add_lobes(sum, side_flux[s].rgb, cosine_lobe(sides[s].normal));
  STORE_LOBES(next_lobes, c, grid.cells.z, sum);
}
