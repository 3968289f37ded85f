// Whether light comes from one cell to another near it, as far as cells can tell.
#ifndef VOLGI_OPEN_WAY_GLSL
#define VOLGI_OPEN_WAY_GLSL
#include "voxel/cell_sides.glsl"
#include "voxel/grid_block.glsl"

#define OPEN_WAY_STEPS 16

// From cell to cell, along the axis with the longest way left that is open.
bool open_way(ivec3 from, ivec3 to) {
  if (!cell_inside(grid, from)) return false;
  for (int step = 0; step < OPEN_WAY_STEPS && from != to; ++step) {
    ivec3 left = to - from;
    uvec2 faces = cell_sides[cell_index(grid, from)];
    int best = -1;
    for (int axis = 0; axis < 3; ++axis) {
      bool longer = left[axis] != 0 && (best < 0 || abs(left[axis]) > abs(left[best]));
      if (longer && !is_opaque(faces, face_of(axis, left[axis] > 0))) best = axis;
    }
    if (best < 0) return false;
    from[best] += left[best] > 0 ? 1 : -1;
  }
  return true;
}

#endif
