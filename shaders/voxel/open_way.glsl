// Whether light comes from a point of a surface to a cell near it, as far as cells can tell.
#ifndef VOLGI_OPEN_WAY_GLSL
#define VOLGI_OPEN_WAY_GLSL
#include "voxel/cell_sides.glsl"
#include "voxel/grid_block.glsl"
#include "voxel/sides.glsl"

#define OPEN_WAY_STEPS 16  // more than a near light is away

// The cell that sees the point: the first whose centre is in front of the point's plane. None where that is behind
// another surface, as outside of a body thinner than a cell whose inside the point lies on.
bool cell_in_front(vec3 point, vec3 normal, out ivec3 cell) {
  cell = ivec3(floor(point + (0.5 * staircase_factor(normal) + 0.02) * normal));
  if (!cell_inside(grid, cell)) return false;
  uvec2 faces = cell_sides[cell_index(grid, cell)];
  for (int face = 0; face < 6; ++face) {
    if (!has_side(faces, face)) continue;
    Side side = sides[side_index(faces, face)];
    vec3 at = vec3(cell) + 0.5;
    at[face_axis(face)] = side.depth;
    // Sides of like normals may be the point's own surface, bent.
    float slack = dot(side.normal, normal) >= SIMILAR_NORMAL_COSINE ? 0.1 : 0.02;
    if (dot(point - at, side.normal) < -slack) return false;
  }
  return true;
}

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
