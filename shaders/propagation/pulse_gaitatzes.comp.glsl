#version 450 core
// One pass of `gaitatzes2010`, gathering (section 4.2, eq. 8; as printed): each neighbour's lobe gives the flux through the
// 90-degree cone towards this cell, which goes on as that cone's lobe. In occupied cells the occupied share is mirrored on
// the axis nearest to the mean normal, accumulated, and sent on times the albedo. Our reading: sh.shared.h, turned_back.
// Set by the program: ORDER = 2
#include "propagation/pulse_lobes.glsl"
#include "propagation/slots.shared.h"
#include "shared/group_sizes.shared.h"
#include "voxel/grid_block.glsl"

layout(local_size_x = CELL_GROUP_X, local_size_y = CELL_GROUP_Y, local_size_z = CELL_GROUP_Z) in;
layout(binding = LOBES_UNIT) uniform sampler3D lobes;
layout(binding = ACCUMULATED_UNIT) uniform sampler3D accumulated;
layout(binding = NORMAL_OCCUPANCY_UNIT) uniform sampler3D normal_occupancy;  // mean normal, occupancy
layout(binding = CELL_ALBEDO_UNIT) uniform sampler3D cell_albedo;
layout(binding = NEXT_LOBES_IMAGE, rgba32f) uniform restrict writeonly image3D next_lobes;
layout(binding = NEXT_ACCUMULATED_IMAGE, rgba32f) uniform restrict writeonly image3D next_accumulated;
uniform bool constant_albedo;  // 0.5, as the paper has it after the first bounce (the injected one)

void gather(ivec3 c, int face, vec4 surface, vec3 albedo, inout vec3 sent[6], inout vec3 bounced[6]) {
  ivec3 n = c + face_step(face);
  if (!cell_inside(grid, n)) return;
  int way = opposite_face(face);  // that light from there travels
  vec3 power = CONE_SHARE * max(along(load_lobes(lobes, n, grid.cells.z), cone_lobe(direction_of_face(way))), vec3(0.0));
  sent[way] += (1.0 - surface.w) * power;
  if (turned_back(surface.xyz, face_axis(way), float(face_sign(way)))) way = face;
  bounced[way] += surface.w * power;
  sent[way] += surface.w * albedo * power;
}

void main() {
  ivec3 c = ivec3(gl_GlobalInvocationID);
  if (!cell_inside(grid, c)) return;
  vec4 surface = texelFetch(normal_occupancy, c, 0);
  vec3 albedo = constant_albedo ? vec3(0.5) : texelFetch(cell_albedo, c, 0).rgb;
  vec3 sent[6], bounced[6];
  for (int face = 0; face < 6; ++face) sent[face] = bounced[face] = vec3(0.0);
  for (int face = 0; face < 6; ++face) gather(c, face, surface, albedo, sent, bounced);
  Lobes next = cone_lobes(sent);
  STORE_LOBES(next_lobes, c, grid.cells.z, next);
  Lobes all = load_lobes(accumulated, c, grid.cells.z);
  Lobes more = cone_lobes(bounced);
  add_lobe(all.red, more.red);
  add_lobe(all.green, more.green);
  add_lobe(all.blue, more.blue);
  STORE_LOBES(next_accumulated, c, grid.cells.z, all);
}
