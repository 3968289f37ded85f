#version 450 core
// One pass of `lpv2009`, gathering (Kaplanyan 2009, light propagation volumes; as printed): from the centre of each
// neighbour to the five faces of this cell that do not touch it, the lobe's intensity there times the solid angle that the
// face shows, sent on as a clamped cosine lobe about the way out. No occlusion, no reflection. All passes accumulate.
// Set by the program: ORDER = 2
#include "propagation/slots.shared.h"
#include "shared/constants.glsl"
#include "propagation/pulse_lobes.glsl"
#include "shared/group_sizes.shared.h"
#include "voxel/grid_block.glsl"

layout(local_size_x = CELL_GROUP_X, local_size_y = CELL_GROUP_Y, local_size_z = CELL_GROUP_Z) in;
layout(binding = LOBES_UNIT) uniform sampler3D lobes;
layout(binding = ACCUMULATED_UNIT) uniform sampler3D accumulated;
layout(binding = NEXT_LOBES_IMAGE, rgba32f) uniform restrict writeonly image3D next_lobes;
layout(binding = NEXT_ACCUMULATED_IMAGE, rgba32f) uniform restrict writeonly image3D next_accumulated;

const float FOUR_PI = 4.0 * PI;

vec3 flux_towards(Lobes from, vec3 direction, float solid_angle) {
  return max(along(from, lobe_about(direction, 1.0, 1.0)), vec3(0.0)) * (solid_angle / FOUR_PI);
}

// Light of the neighbour beyond `face`, through this cell's five other faces.
void gather(ivec3 c, int face, inout vec3 power[6]) {
  ivec3 n = c + face_step(face);
  if (!cell_inside(grid, n)) return;
  Lobes from = load_lobes(lobes, n, grid.cells.z);
  vec3 travel = -direction_of_face(face);
  power[opposite_face(face)] += flux_towards(from, travel, LPV_FAR_SOLID_ANGLE);
  for (int out_face = 0; out_face < 6; ++out_face) {
    if (face_axis(out_face) == face_axis(face)) continue;
    vec3 direction = LPV_SIDE_ALONG * travel + LPV_SIDE_ACROSS * direction_of_face(out_face);
    power[out_face] += flux_towards(from, direction, LPV_SIDE_SOLID_ANGLE);
  }
}

void main() {
  ivec3 c = ivec3(gl_GlobalInvocationID);
  if (!cell_inside(grid, c)) return;
  vec3 power[6];
  for (int face = 0; face < 6; ++face) power[face] = vec3(0.0);
  for (int face = 0; face < 6; ++face) gather(c, face, power);
  Lobes next = cosine_lobes(power);
  STORE_LOBES(next_lobes, c, grid.cells.z, next);
  Lobes all = load_lobes(accumulated, c, grid.cells.z);
  add_lobe(all.red, next.red);
  add_lobe(all.green, next.green);
  add_lobe(all.blue, next.blue);
  STORE_LOBES(next_accumulated, c, grid.cells.z, all);
}
