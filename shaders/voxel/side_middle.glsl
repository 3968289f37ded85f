// A point for all of a side's surface.
#ifndef VOLGI_SIDE_MIDDLE_GLSL
#define VOLGI_SIDE_MIDDLE_GLSL
#include "voxel/cell_sides.glsl"
#include "voxel/grid_block.glsl"
#include "voxel/sides.glsl"

// Cell units: on the line through the middle of what the cell's other sides leave of the cell; those of its own surface
// leave all. Twin: propagation/light_in/side_start_internal.h.
vec3 middle_of(Side side) {
  ivec3 cell = cell_coord(grid, side.cell);
  uvec2 faces = cell_sides[side.cell];
  vec3 low = vec3(cell), high = low + 1.0;
  for (int face = 0; face < 6; ++face) {
    if (!has_side(faces, face)) continue;
    uint other = side_index(faces, face);
    if (dot(sides[other].normal, side.normal) >= SIMILAR_NORMAL_COSINE) continue;
    if (face_sign(face) < 0) low[face_axis(face)] = sides[other].depth;
    else high[face_axis(face)] = sides[other].depth;
  }
  vec3 off = mix(vec3(0.0), 0.5 * (low + high) - vec3(cell) - 0.5, lessThan(low, high));
  int axis = face_axis(side.face);
  off[axis] = 0.0;
  // Along the side's plane; a plane that the face's axis hardly meets is not followed far.
  float slope = max(abs(side.normal[axis]), 0.1) * (side.normal[axis] < 0.0 ? -1.0 : 1.0);
  vec3 middle = vec3(cell) + 0.5 + off;
  middle[axis] = side.depth - dot(side.normal, off) / slope;
  return middle;
}

#endif
