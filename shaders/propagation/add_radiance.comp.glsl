#version 450 core
// Adds the lobes that are in the cells now to the cells' radiance: summed over passes they are all the light that went
// through a cell (sh.shared.h, radiance_from_lobe).
// Set by the program: ORDER = 2
#include "propagation/lobes.glsl"
#include "propagation/slots.shared.h"
#include "shared/group_sizes.shared.h"
#include "voxel/grid_block.glsl"

layout(local_size_x = CELL_GROUP_X, local_size_y = CELL_GROUP_Y, local_size_z = CELL_GROUP_Z) in;
layout(binding = LOBES_UNIT) uniform sampler3D lobes;
layout(binding = LOBES_RADIANCE_IMAGE, rgba32f) uniform restrict image3D radiance_sh;  // coefficients stacked in z
uniform bool stored_rescaled;  // `conservative`: what a lobe carries is the sum of what its faces pass
uniform float odd_sign;        // -1: of light that comes from where it went to

void add(ivec3 c, int coefficient, float red, float green, float blue) {
  ivec3 texel = c + ivec3(0, 0, coefficient * grid.cells.z);
  float sign = coefficient >= 1 && coefficient <= 3 ? odd_sign : 1.0;
  vec3 more = sign * radiance_from_lobe(grid.cell_size_m) * vec3(red, green, blue);
  imageStore(radiance_sh, texel, imageLoad(radiance_sh, texel) + vec4(more, 0.0));
}

// From the stored lobe to the one before it was rescaled, whose first number is its power.
float unscaled(Lobe lobe) {
  if (!stored_rescaled || lobe_power(lobe) <= 0.0) return 1.0;
  float carried = 0.0;
  for (int face = 0; face < 6; ++face) carried += flux_passed(lobe, face);
  return carried / lobe_power(lobe);
}

void main() {
  ivec3 c = ivec3(gl_GlobalInvocationID);
  if (!cell_inside(grid, c)) return;
  Lobes own = load_lobes(lobes, c, grid.cells.z);
  vec3 u = vec3(unscaled(own.red), unscaled(own.green), unscaled(own.blue));
#if ORDER == 1
  for (int i = 0; i < 4; ++i) add(c, i, u.r * own.red[i], u.g * own.green[i], u.b * own.blue[i]);
#else
  for (int i = 0; i < 4; ++i) {
    add(c, i, u.r * own.red.low[i], u.g * own.green.low[i], u.b * own.blue.low[i]);
    add(c, 4 + i, u.r * own.red.mid[i], u.g * own.green.mid[i], u.b * own.blue.mid[i]);
  }
  add(c, 8, u.r * own.red.high, u.g * own.green.high, u.b * own.blue.high);
#endif
}
