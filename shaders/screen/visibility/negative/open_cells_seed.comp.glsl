#version 450 core
// The cell in front of each virtual light is open, unless it may lie behind a surface: in a corner or on a slope the
// cell's centre, which decides, can be on the other side, and one such cell would open all that is closed. Light has
// more than one virtual light.
#include "screen/base/virtual_lights.glsl"
#include "shared/global_index.shared.h"
#include "screen/visibility/negative/open_cells.glsl"
#include "shared/group_sizes.shared.h"
#include "voxel/sides.glsl"

layout(local_size_x = LINEAR_GROUP) in;
uniform int light_count;

#define MIN_CELLS 0.02  // a light is this far in front of surfaces other than its own; depths err by far less

bool in_front_of_all_sides(ivec3 cell, vec3 light, vec3 normal) {
  uvec2 of_cell = cell_sides[cell_index(grid, cell)];
  for (int face = 0; face < 6; ++face) {
    if (!has_side(of_cell, face)) continue;
    uint index = side_index(of_cell, face);
    if (index >= uint(sides.length())) return false;
    Side side = sides[index];
    vec3 at = vec3(cell) + 0.5;
    at[face >> 1] = side.depth;
    bool own = dot(side.normal, normal) > 0.9;
    if (!own && dot(light - at, side.normal) < MIN_CELLS) return false;
  }
  return true;
}

void main() {
  int i = int(global_index());
  if (i >= light_count || lights[i].flux == vec3(0.0)) return;
  vec3 light = cell_from_world(grid, lights[i].position);
  // So far that the centre of the cell is in front of the light's plane.
  ivec3 cell = ivec3(floor(light + (0.5 * staircase_factor(lights[i].normal) + MIN_CELLS) * lights[i].normal));
  if (cell_inside(grid, cell) && in_front_of_all_sides(cell, light, lights[i].normal))
    open_cells[cell_index(grid, cell)] = 1u;
}
