#version 450 core
// Starts a pulse of gaitatzes2010 as the paper has it (section 4.1, Algorithm 1: "the maximum radiosity of each cell"): in
// every occupied cell a light of the area of a cell's face, with a cosine falloff about the mean normal. Its radiosity is
// the largest that surfaces in the cell emit, and the largest that its sides reflect. Our reading: docs/theory.md#papers.
// Set by the program: ORDER = 2
#include "propagation/pulse_lobes.glsl"
#include "propagation/slots.shared.h"
#include "shared/group_sizes.shared.h"
#include "voxel/cell_sides.glsl"
#include "voxel/grid_block.glsl"
#include "voxel/sides.glsl"

layout(local_size_x = CELL_GROUP_X, local_size_y = CELL_GROUP_Y, local_size_z = CELL_GROUP_Z) in;
layout(binding = NORMAL_OCCUPANCY_UNIT) uniform sampler3D normal_occupancy;  // mean normal, occupancy
layout(binding = CELL_EMISSION_UNIT) uniform sampler3D emission;             // largest radiosity pi L_e
layout(binding = NEXT_LOBES_IMAGE, rgba32f) uniform restrict writeonly image3D next_lobes;
layout(std430, binding = SIDE_FLUX_SLOT) readonly buffer SideFlux { vec4 side_flux[]; };  // A B0 [W]

vec3 radiosity_of_side(ivec3 cell, int face) {
  uvec2 own = cell_sides[cell_index(grid, cell)];
  if (!has_side(own, face)) return vec3(0.0);
  uint s = side_index(own, face);
  return side_flux[s].rgb / max(sides[s].area_m2, LEAST_SIDE_AREA * grid.cell_size_m * grid.cell_size_m);
}

void main() {
  ivec3 c = ivec3(gl_GlobalInvocationID);
  if (!cell_inside(grid, c)) return;
  vec4 surface = texelFetch(normal_occupancy, c, 0);
  Lobes lobes = dark_lobes();
  if (surface.w > 0.0) {
    vec3 reflected = vec3(0.0);
    for (int face = 0; face < 6; ++face) {
      reflected = max(reflected, radiosity_of_side(c, face));
      // A cell in front that holds no surface itself: what it sees lies in this one.
      ivec3 beside = c + face_step(face);
      if (!cell_inside(grid, beside) || texelFetch(normal_occupancy, beside, 0).w > 0.0) continue;
      reflected = max(reflected, radiosity_of_side(beside, opposite_face(face)));
    }
    vec3 power = (texelFetch(emission, c, 0).rgb + reflected) * grid.cell_size_m * grid.cell_size_m;
    // Where normals cancel, light leaves to all sides.
    bool turned = surface.xyz != vec3(0.0);
    add_lobes(lobes, power, turned ? cosine_lobe(surface.xyz) : lobe_about(vec3(0.0, 0.0, 1.0), 0.0, 0.0));
  }
  STORE_LOBES(next_lobes, c, grid.cells.z, lobes);
}
