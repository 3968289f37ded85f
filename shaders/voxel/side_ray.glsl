// The first side that a ray meets from its front.
#ifndef VOLGI_SIDE_RAY_GLSL
#define VOLGI_SIDE_RAY_GLSL
#include "voxel/cell_sides.glsl"
#include "voxel/grid_block.glsl"
#include "voxel/seeing_cells.glsl"
#include "voxel/sides.glsl"

// Cells: what rounded vertices move a surface by.
#define ROUNDED (2.0 / float(SLICE_STEPS))

float unit_hash(uint x) {  // lowbias32, Ellis 2018
  x ^= x >> 16;
  x *= 0x7feb352du;
  x ^= x >> 15;
  x *= 0x846ca68bu;
  x ^= x >> 16;
  return float(x >> 8) / 16777216.0;
}

// A point of the side's plane, in its cell's column.
vec3 point_of(Side side, ivec3 cell) {
  vec3 at = vec3(cell) + 0.5;
  at[face_axis(side.face)] = side.depth;
  return at;
}

// How far along the ray a cell's side is met, from `entry` on (cell units along `way`), before it leaves through `exit_face`
// after `length`. FAR: not at all; what comes from behind a side passes it.
#define FAR_AWAY 3.0e38
float side_distance(Side side, ivec3 cell, vec3 entry, vec3 way, int exit_face, float cell_length) {
  float towards = -dot(way, side.normal);
  float height = dot(entry - point_of(side, cell), side.normal);
  if (!(towards > 0.0) || height < -ROUNDED) return FAR_AWAY;
  float distance = max(height, 0.0) / towards;
  // At the face that it blocks, whatever is left to its plane: beyond, another cell would see the surface from behind.
  if (side.face == exit_face) return min(distance, cell_length);
  return distance <= cell_length ? distance : FAR_AWAY;
}

// @param point  of a surface with that normal, cell units. @param way  unit, in front of the surface. @param seed  of the ray: what
// partly covered sides let pass. @param met_at  on its plane, cell units. @return the side's index; -1: the ray leaves the grid.
int side_met(vec3 point, vec3 normal, vec3 way, uint seed, out vec3 met_at) {
  ivec3 cell = seeing_cell(point, normal);
  vec3 entry = point;
  int most = grid.cells.x + grid.cells.y + grid.cells.z;
  for (int step = 0; step < most && cell_inside(grid, cell); ++step) {
    vec3 to_faces = (vec3(cell) + vec3(greaterThan(way, vec3(0.0))) - entry) / way;
    int axis = to_faces.x <= to_faces.y ? (to_faces.x <= to_faces.z ? 0 : 2) : (to_faces.y <= to_faces.z ? 1 : 2);
    float cell_length = max(to_faces[axis], 0.0);
    int exit_face = face_of(axis, way[axis] > 0.0);
    uvec2 faces = cell_sides[cell_index(grid, cell)];
    float nearest = FAR_AWAY;
    int met = -1;
    for (int face = 0; face < 6 && (faces.y & 63u) != 0u; ++face) {
      if (!has_side(faces, face)) continue;
      int s = int(side_index(faces, face));
      float distance = side_distance(sides[s], cell, entry, way, exit_face, cell_length);
      if (distance >= nearest || unit_hash(seed * 2654435769u + uint(s)) >= sides[s].coverage) continue;
      nearest = distance;
      met = s;
    }
    if (met >= 0) {
      met_at = entry + nearest * way;
      met_at -= dot(met_at - point_of(sides[met], cell), sides[met].normal) * sides[met].normal;
      return met;
    }
    entry += cell_length * way;
    cell[axis] += way[axis] > 0.0 ? 1 : -1;
  }
  return -1;
}

#endif
