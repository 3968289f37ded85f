// Whether the light that leaves a body at a side entered it straight from its source: where another body is in between,
// that one's own exit takes the light away, and nothing may be taken twice.
#ifndef VOLGI_FIRST_PASSAGE_GLSL
#define VOLGI_FIRST_PASSAGE_GLSL
#include "screen/visibility/negative/open_cells.glsl"

// Walks back from a side's surface (cell units, seen from `cell`) to a point in front of the source: out through the
// first opaque face, on through what is closed to light, and then no opaque face may come.
bool is_first_passage(vec3 surface, ivec3 cell, vec3 source) {
  vec3 way = source - surface;
  ivec3 step = ivec3(sign(way));
  vec3 per_cell = 1.0 / max(abs(way), vec3(1e-12));
  vec3 start = vec3(cell) + clamp(surface - vec3(cell), vec3(0.0), vec3(1.0));
  vec3 next = mix(start - vec3(cell), vec3(cell) + 1.0 - start, greaterThan(way, vec3(0.0))) * per_cell;
  bool entered = false, passed = false;
  for (int i = 0; i < grid.cells.x + grid.cells.y + grid.cells.z; ++i) {
    int axis = next.x <= next.y && next.x <= next.z ? 0 : next.y <= next.z ? 1 : 2;
    if (next[axis] >= 1.0) break;
    bool opaque_face = face_is_opaque(cell, face_of(axis, step[axis] > 0));
    if (passed && opaque_face) return false;
    entered = entered || opaque_face;
    cell[axis] += step[axis];
    if (!cell_inside(grid, cell)) break;
    passed = entered && open_cells[cell_index(grid, cell)] != 0u;
    next[axis] += per_cell[axis];
  }
  return true;
}

#endif
