// The volume's frame and every index formula of it, in inverse pairs (round trip: tests/voxel/grid_test.cpp).
#ifndef VOLGI_GRID_SHARED_H
#define VOLGI_GRID_SHARED_H
#include "shared/base.shared.h"
SHARED_BEGIN

// Cell (i,j,k) has its centre at origin + h (i+1/2, j+1/2, k+1/2). std430/std140: 32 bytes.
struct Grid {
  ivec3 cells;
  float cell_size_m;  // h
  vec3 origin;        // lowest corner, centred world frame
  float pad;
};
#ifdef __cplusplus
static_assert(sizeof(Grid) == 32 && offsetof(Grid, cell_size_m) == 12 && offsetof(Grid, origin) == 16);
#endif

// Faces of a cell: 0 -x, 1 +x, 2 -y, 3 +y, 4 -z, 5 +z.
SHARED_FUNCTION int face_of(int axis, bool positive) { return 2 * axis + (positive ? 1 : 0); }
SHARED_FUNCTION int face_axis(int face) { return face >> 1; }
SHARED_FUNCTION int face_sign(int face) { return (face & 1) * 2 - 1; }
SHARED_FUNCTION int opposite_face(int face) { return face ^ 1; }
SHARED_FUNCTION ivec3 face_step(int face) {
  ivec3 step = ivec3(0, 0, 0);
  step[face >> 1] = (face & 1) * 2 - 1;
  return step;
}

SHARED_FUNCTION bool cell_inside(Grid grid, ivec3 c) {
  return c.x >= 0 && c.y >= 0 && c.z >= 0 && c.x < grid.cells.x && c.y < grid.cells.y && c.z < grid.cells.z;
}

// Cell <-> offset, x fastest.
SHARED_FUNCTION int cell_index(Grid grid, ivec3 c) { return c.x + grid.cells.x * (c.y + grid.cells.y * c.z); }
SHARED_FUNCTION ivec3 cell_coord(Grid grid, int index) {
  int row = index / grid.cells.x;
  return ivec3(index - row * grid.cells.x, row % grid.cells.y, row / grid.cells.y);
}

// World <-> cell units (cell (i,j,k) spans [i,i+1) x [j,j+1) x [k,k+1)).
SHARED_FUNCTION vec3 cell_from_world(Grid grid, vec3 world) { return (world - grid.origin) / grid.cell_size_m; }
SHARED_FUNCTION vec3 world_from_cell(Grid grid, vec3 cell) { return grid.origin + cell * grid.cell_size_m; }

// Face i of the column (b,c) along `axis` lies between the cells i-1 and i, i in 0 ... cells[axis]; (b,c) are the
// coordinates on the axes axis+1 and axis+2 (cyclic). Faces of one axis <-> offset, column fastest.
SHARED_FUNCTION int axis_b(int axis) { return axis == 2 ? 0 : axis + 1; }
SHARED_FUNCTION int axis_c(int axis) { return axis == 0 ? 2 : axis - 1; }
SHARED_FUNCTION int face_count(Grid grid, int axis) {
  return (grid.cells[axis] + 1) * grid.cells[axis_b(axis)] * grid.cells[axis_c(axis)];
}
SHARED_FUNCTION int face_index(Grid grid, int axis, ivec3 face_cell) {  // face_cell[axis] = i
  int b = axis_b(axis);
  int c = axis_c(axis);
  return face_cell[b] + grid.cells[b] * (face_cell[c] + grid.cells[c] * face_cell[axis]);
}
SHARED_FUNCTION ivec3 face_coord(Grid grid, int axis, int index) {
  int b = axis_b(axis);
  int c = axis_c(axis);
  int row = index / grid.cells[b];
  ivec3 face_cell = ivec3(0, 0, 0);
  face_cell[b] = index - row * grid.cells[b];
  face_cell[c] = row % grid.cells[c];
  face_cell[axis] = row / grid.cells[c];
  return face_cell;
}

// Vertices as the slicing passes see them: rounded to 1/384 of a cell, so that which columns a triangle covers and
// which cell centres lie behind it can be answered exactly. The answers then are about one surface, and what is closed
// in the scene is closed in the volume. 384 = 2^7 3: the centres of cells and the nodes of the lattice three times
// finer, node 3 cell + sub at (2 node + 1) 64 steps, are whole numbers. In a grid of 256 cells coordinates stay under
// 2^16.7, cross products under 2^34.4 and the terms of a determinant under 2^51.1: exact in double precision. The CPU
// takes 64-bit integers and is exact to 1024 cells.
#define SLICE_STEPS 384  // of a cell
SHARED_FUNCTION ivec3 slice_vertex(vec3 cell) { return ivec3(floor(cell * float(SLICE_STEPS) + 0.5f)); }

// Which way a plane through a cell's centre falls: below it (true), or above, as all centres count as moved by (e, e^2,
// e^3) (lattice.glsl). `normal` of either side.
SHARED_FUNCTION bool falls_below_centre(vec3 normal, int axis) {
  const float nothing = 1e-4f;  // of a cell in some hundred: less than vertices are rounded by
  float first = abs(normal.x) > nothing ? normal.x : abs(normal.y) > nothing ? normal.y : normal.z;
  return first * normal[axis] > 0.0f;
}

// The face whose two cell centres a depth `x` (cell units along the axis) lies between, rounded as vertices are, so
// that a wall through cell centres is looked for where it is: beside it may be another one that faces alike. For
// finding sides again; which faces are blocked, the slicing passes decide exactly (slice.frag.glsl).
SHARED_FUNCTION int face_of_depth(float x, bool below_centre) {
  float steps = floor(x * float(SLICE_STEPS) + 0.5f);
  float to_next = 0.5f * float(SLICE_STEPS) + (below_centre ? -0.5f : 0.5f);
  return int(floor((steps + to_next) * (1.0f / float(SLICE_STEPS))));
}

SHARED_END
#endif
