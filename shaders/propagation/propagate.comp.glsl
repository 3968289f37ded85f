#version 450 core
// One pass of the `conservative` scheme over the volume, gathering (docs/theory.md#conservative). Every cell's lobe leaves
// through its six faces by its power there, clamped at zero and rescaled to the lobe's power; blocked faces keep the share
// tau for the side there. Gaitatzes 2010 section 4.2, eq. 8 gathers alike; we depart: the exact flux through
// the face for a cone, power kept, sides for axis mirrors.
// Set by the program: ORDER = 2
#include "propagation/crossing.glsl"
#include "propagation/slots.shared.h"
#include "shared/group_sizes.shared.h"
#include "voxel/cell_sides.glsl"
#include "voxel/grid_block.glsl"
#include "voxel/sides.glsl"

layout(local_size_x = CELL_GROUP_X, local_size_y = CELL_GROUP_Y, local_size_z = CELL_GROUP_Z) in;
layout(binding = LOBES_UNIT) uniform sampler3D lobes;
layout(binding = NEXT_LOBES_IMAGE, rgba32f) uniform restrict writeonly image3D next_lobes;
layout(std430, binding = RECEIVED_SLOT) restrict buffer Received { vec4 received[]; };  // power per side [W]
uniform bool reflect_hits;  // send what sides receive on at once: all orders in flight together

void gather(ivec3 c, int face, float share, inout Lobes sum) {
  int axis = face >> 1;
  float sign = (face & 1) != 0 ? -1.0 : 1.0;  // light from the neighbour at +x travels along -x
  ivec3 n = c;
  n[axis] += (face & 1) * 2 - 1;
  Lobes from = load_lobes(lobes, n, grid.cells.z);
  add_lobe(sum.red, share, crossing(from.red, axis, sign));
  add_lobe(sum.green, share, crossing(from.green, axis, sign));
  add_lobe(sum.blue, share, crossing(from.blue, axis, sign));
}

void main() {
  ivec3 c = ivec3(gl_GlobalInvocationID);
  if (!cell_inside(grid, c)) return;
  uvec2 own_sides = cell_sides[cell_index(grid, c)];
  uint closed = own_sides.y >> 8;  // nothing comes through these
  if (c.x == 0) closed |= 1u;
  if (c.y == 0) closed |= 4u;
  if (c.z == 0) closed |= 16u;
  if (c.x == grid.cells.x - 1) closed |= 2u;
  if (c.y == grid.cells.y - 1) closed |= 8u;
  if (c.z == grid.cells.z - 1) closed |= 32u;

  Lobes sum = dark_lobes();
  if ((closed & 1u) == 0u) gather(c, 0, 1.0, sum);
  if ((closed & 2u) == 0u) gather(c, 1, 1.0, sum);
  if ((closed & 4u) == 0u) gather(c, 2, 1.0, sum);
  if ((closed & 8u) == 0u) gather(c, 3, 1.0, sum);
  if ((closed & 16u) == 0u) gather(c, 4, 1.0, sum);
  if ((closed & 32u) == 0u) gather(c, 5, 1.0, sum);

  if ((own_sides.y & 63u) != 0u) {
    Lobes own = load_lobes(lobes, c, grid.cells.z);
    for (int face = 0; face < 6; ++face) {
      if (!has_side(own_sides, face)) continue;
      uint index = side_index(own_sides, face);
      float tau = is_opaque(own_sides, face) ? 1.0 : sides[index].coverage;
      if (tau < 1.0 && (closed & (1u << face)) == 0u) gather(c, face, -tau, sum);  // passed whole above
      vec3 hit = tau * hit_power(own, face);
      received[index].rgb += hit;
      if (reflect_hits) {
        vec3 power = hit * side_returned_fraction(sides[index].albedo, sides[index].area_m2, sides[index].face_m2);
        add_lobes(sum, power, lobe_of_side(face));
      }
    }
  }
  keep_power(sum);
  STORE_LOBES(next_lobes, c, grid.cells.z, sum);
}
