#version 450 core
// One pass of the `conservative` scheme over the volume, gathering (docs/theory.md#conservative). Every cell's lobe leaves
// through its six faces by the lobe's integral over the face's pyramid, clamped at zero and rescaled to the lobe's power;
// blocked faces keep the share tau for the side there. Lobes are stored already rescaled (sh.shared.h, clamp_rescale).
// Gaitatzes 2010 section 4.2, eq. 8 gathers alike; we depart: exact pyramids for cones, power kept, sides for axis mirrors.
#include "shared/grid.shared.h"
#include "shared/side.shared.h"
#include "shared/sh.shared.h"

layout(local_size_x = 8, local_size_y = 8, local_size_z = 4) in;
layout(std140, binding = 0) uniform GridBlock { Grid grid; };
layout(binding = 0) uniform sampler3D lobes;                              // three bands stacked in z
layout(binding = 0, rgba32f) uniform restrict writeonly image3D next_lobes;
layout(std430, binding = 3) readonly buffer CellSides { uvec2 cell_sides[]; };
layout(std430, binding = 4) readonly buffer Sides { Side sides[]; };
layout(std430, binding = 6) restrict buffer Received { vec4 received[]; };  // power per side [W]
uniform bool reflect_hits;  // send what sides receive on at once: all orders in flight together

// The part of a neighbour's lobe that crosses the face in direction `face`.
vec4 crossing(vec4 lobe, int axis, float sign) {
  int component = sh_component(axis);
  float axial = lobe[component];
  float power = PYRAMID_CONSTANT * lobe.x + sign * PYRAMID_AXIS * axial;
  vec4 moved = PYRAMID_TRANSVERSE * lobe;
  moved.x = power;
  moved[component] = sign * PYRAMID_AXIS * lobe.x + PYRAMID_AXIS_AXIS * axial;
  return power > 0.0 ? moved : vec4(0.0);
}

void gather(ivec3 c, int face, float share, inout vec4 red, inout vec4 green, inout vec4 blue) {
  int axis = face >> 1;
  float sign = (face & 1) != 0 ? -1.0 : 1.0;  // light from the neighbour at +x travels along -x
  ivec3 n = c;
  n[axis] += (face & 1) * 2 - 1;
  red += share * crossing(texelFetch(lobes, n, 0), axis, sign);
  green += share * crossing(texelFetch(lobes, n + ivec3(0, 0, grid.cells.z), 0), axis, sign);
  blue += share * crossing(texelFetch(lobes, n + ivec3(0, 0, 2 * grid.cells.z), 0), axis, sign);
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

  vec4 red = vec4(0.0), green = vec4(0.0), blue = vec4(0.0);
  if ((closed & 1u) == 0u) gather(c, 0, 1.0, red, green, blue);
  if ((closed & 2u) == 0u) gather(c, 1, 1.0, red, green, blue);
  if ((closed & 4u) == 0u) gather(c, 2, 1.0, red, green, blue);
  if ((closed & 8u) == 0u) gather(c, 3, 1.0, red, green, blue);
  if ((closed & 16u) == 0u) gather(c, 4, 1.0, red, green, blue);
  if ((closed & 32u) == 0u) gather(c, 5, 1.0, red, green, blue);

  if ((own_sides.y & 63u) != 0u) {
    vec4 own_red = texelFetch(lobes, c, 0);
    vec4 own_green = texelFetch(lobes, c + ivec3(0, 0, grid.cells.z), 0);
    vec4 own_blue = texelFetch(lobes, c + ivec3(0, 0, 2 * grid.cells.z), 0);
    for (int face = 0; face < 6; ++face) {
      if (!has_side(own_sides, face)) continue;
      uint index = side_index(own_sides, face);
      float tau = is_opaque(own_sides, face) ? 1.0 : sides[index].coverage;
      if (tau < 1.0 && (closed & (1u << face)) == 0u) gather(c, face, -tau, red, green, blue);  // passed whole above
      vec3 hit = tau * max(vec3(pyramid_power(own_red, face), pyramid_power(own_green, face), pyramid_power(own_blue, face)), vec3(0.0));
      received[index].rgb += hit;
      if (reflect_hits) {
        vec3 power = hit * side_returned_fraction(sides[index].albedo, sides[index].area_m2, sides[index].face_m2);
        vec4 lobe = side_lobe(face);
        red += power.r * lobe;
        green += power.g * lobe;
        blue += power.b * lobe;
      }
    }
  }
  imageStore(next_lobes, c, red * clamp_rescale(red));
  imageStore(next_lobes, c + ivec3(0, 0, grid.cells.z), green * clamp_rescale(green));
  imageStore(next_lobes, c + ivec3(0, 0, 2 * grid.cells.z), blue * clamp_rescale(blue));
}
