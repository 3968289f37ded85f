#version 450 core
// Bands in which light leaves a cell at once: through the grid's rim, or into a side that is not white.
#include "shared/global_index.shared.h"
#include "shared/group_sizes.shared.h"
#include "voxel/sides.glsl"
#include "voxel/white_pockets.glsl"

layout(local_size_x = LINEAR_GROUP) in;

void main() {
  int i = int(global_index());
  if (i >= grid.cells.x * grid.cells.y * grid.cells.z) return;
  ivec3 cell = cell_coord(grid, i);
  uvec2 of_cell = cell_sides[i];
  uint bands = 0u;
  for (int face = 0; face < 6; ++face) {
    if (!is_opaque(of_cell, face) && !cell_inside(grid, cell + face_step(face))) bands = ALL_BANDS;
    if (!has_side(of_cell, face)) continue;
    uint side = side_index(of_cell, face);
    if (side < uint(sides.length())) bands |= bands_below_white(sides[side].albedo);
  }
  leaving[i] = bands;
}
