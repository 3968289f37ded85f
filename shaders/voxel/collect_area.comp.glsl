#version 450 core
// Gives the sides of one axis the areas that side_area has counted, and their surfaces, too, which later frames that slice
// along other axes take them from.
#include "shared/global_index.shared.h"
#include "shared/group_sizes.shared.h"
#include "shared/side.shared.h"
#include "voxel/grid_block.glsl"
#include "voxel/side_count.glsl"
#include "voxel/surfaces.glsl"

layout(local_size_x = LINEAR_GROUP) in;
layout(std430, binding = AREA_FIXED_SLOT) readonly buffer AreaFixed { uint area_fixed[]; };
layout(std430, binding = AREA_ENTRIES_SLOT) readonly buffer Entries { uint entries[]; };
layout(std430, binding = AREA_SURFACES_SLOT) buffer Surfaces { Surface surfaces[]; };
layout(std430, binding = SIDES_SLOT) buffer Sides { Side sides[]; };
uniform int axis;

void main() {
  uint i = global_index();
  if (i >= side_count) return;
  Side side = sides[i];
  if (face_axis(side.face) != axis) return;
  float area_m2 = float(area_fixed[i]) / 1048576.0 * grid.cell_size_m * grid.cell_size_m;
  area_m2 = max(area_m2, SIDE_MIN_FILL * side.face_m2 / staircase_factor(side.normal));
  sides[i].area_m2 = area_m2;
  ivec3 upper = cell_coord(grid, side.cell);
  upper[axis] += side.face & 1;
  uint entry = entries[face_index(grid, axis, upper)];
  if (entry != NO_ENTRY) surfaces[2u * entry + 1u - uint(side.face & 1)].area_m2 = area_m2;
}
