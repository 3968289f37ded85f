#version 450 core
// Gives the sides of one axis the areas that side_area has counted, and their surfaces, too, which later frames that slice
// along other axes take them from.
#include "shared/global_index.shared.h"
#include "shared/grid.shared.h"
#include "shared/side.shared.h"
#include "voxel/surfaces.glsl"

layout(local_size_x = 64) in;
layout(std140, binding = 0) uniform GridBlock { Grid grid; };
layout(std430, binding = 0) readonly buffer AreaFixed { uint area_fixed[]; };
layout(std430, binding = 1) readonly buffer Entries { uint entries[]; };
layout(std430, binding = 2) buffer Surfaces { Surface surfaces[]; };
layout(std430, binding = 4) buffer Sides { Side sides[]; };
layout(std430, binding = 5) readonly buffer SideCount { uint side_count; };
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
