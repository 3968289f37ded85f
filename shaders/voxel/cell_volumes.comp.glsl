#version 450 core
// Turns the sums of each cell into what is kept of it.
#include "shared/group_sizes.shared.h"
#include "shared/storage.glsl"
#include "voxel/cell_sums.glsl"
#include "voxel/grid_block.glsl"

layout(local_size_x = CELL_GROUP_X, local_size_y = CELL_GROUP_Y, local_size_z = CELL_GROUP_Z) in;
layout(STORED_RGBA16F, binding = NORMAL_OCCUPANCY_IMAGE) writeonly uniform image3D normal_occupancy;
layout(STORED_RGBA16F, binding = CELL_ALBEDO_IMAGE) writeonly uniform image3D albedo;
layout(rgba32f, binding = CELL_EMISSION_IMAGE) writeonly uniform image3D emission;

void main() {
  ivec3 c = ivec3(gl_GlobalInvocationID);
  if (!cell_inside(grid, c)) return;
  int cell = cell_index(grid, c);
  uvec2 a = cell_sums[0].at[cell], b = cell_sums[1].at[cell], d = cell_sums[2].at[cell];
  uvec2 e = cell_sums[3].at[cell], f = cell_sums[4].at[cell], g = cell_sums[5].at[cell];
  float area = max(float(a.x), 1.0);
  vec3 normal = vec3(int(d.y), int(e.x), int(e.y)) / area;
  float size = length(normal);
  normal = size < 1e-3 ? vec3(0.0) : normal / size;  // sheets that look away from each other
  imageStore(normal_occupancy, c, vec4(normal, uintBitsToFloat(a.y)));
  imageStore(albedo, c, vec4(vec3(b, d.x) / area, a.x > 0u ? 1.0 : 0.0));
  imageStore(emission, c, vec4(uintBitsToFloat(uvec3(f, g.x)), 0.0));
}
