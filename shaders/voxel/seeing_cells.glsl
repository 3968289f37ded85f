// Which of the eight cells around a place see a point of a surface: a cell's centre may lie behind a sheet that the point
// is in front of. A cell does not see the point if it is behind the point's own plane, or if one of its opaque sides hides
// it. A cell beyond both walls of a corner has no side there and does not know; so the cells that do, which have a side
// towards another of the eight with the point in front of it, come first, and only what open faces join to the first of them
// is on the point's side. Twin: voxel/seeing_cells.cpp.
#ifndef VOLGI_SEEING_CELLS_GLSL
#define VOLGI_SEEING_CELLS_GLSL
#include "voxel/cell_sides.glsl"
#include "voxel/grid_block.glsl"
#include "voxel/sides.glsl"

// Of eight corners, those on the lower side of each axis.
const uint LOW_CORNERS[3] = uint[3](0x55u, 0x33u, 0x0fu);

struct SeeingCells {
  ivec3 low;    // of the eight; bits of a corner's number are its steps along x, y, z
  int nearest;  // corner on the point's side, nearest to the place; it may be outside of the grid; -1: none is
  uint joined;  // bits of the corners on the point's side
};

ivec3 corner_cell(SeeingCells c, int corner) { return c.low + ivec3(corner & 1, (corner >> 1) & 1, corner >> 2); }

// What the sides of a cell say of the point: -1 that one hides it; 1 that it is in front of one towards another of the
// eight; 0 nothing.
int corner_sees(ivec3 cell, uvec2 own_sides, int corner, vec3 point, vec3 normal) {
  int sees = 0;
  uint count = count_bits(own_sides.y & 63u);
  for (uint s = own_sides.x; s < own_sides.x + count; ++s) {
    if (side_hides(sides[s], cell, point, normal)) return -1;
    bool inner = (sides[s].face & 1) != ((corner >> (sides[s].face >> 1)) & 1);
    if (inner && sides[s].coverage == 1.0 && dot(sides[s].normal, normal) < SIMILAR_NORMAL_COSINE &&
        height_over_side(sides[s], cell, point) > 0.0)
      sees = 1;
  }
  return sees;
}

// `around` and `point` in cell units.
SeeingCells seeing_cells(vec3 around, vec3 point, vec3 normal) {
  SeeingCells c = SeeingCells(ivec3(floor(around - 0.5)), -1, 0u);
  uint closed[3] = uint[3](0u, 0u, 0u);  // bits of the two corners on either side of a closed face
  uint unhidden = 0u;
  float best = 1e30;
  for (int k = 0; k < 8; ++k) {
    ivec3 cell = corner_cell(c, k);
    uvec2 own_sides = cell_inside(grid, cell) ? cell_sides[cell_index(grid, cell)] : uvec2(0u);
    for (int axis = 0; axis < 3; ++axis) {
      int face = 2 * axis + 1 - ((k >> axis) & 1);
      if (is_opaque(own_sides, face)) closed[axis] |= 1u << k | 1u << (k ^ (1 << axis));
    }
    if (dot(vec3(cell) + 0.5 - point, normal) < -SEEING_BEHIND) continue;
    int sees = corner_sees(cell, own_sides, k, point, normal);
    if (sees < 0) continue;
    unhidden |= 1u << k;
    vec3 d = vec3(cell) + 0.5 - around;
    float score = dot(d, d) - SEEING_FIRST * float(sees);
    if (score >= best) continue;
    best = score;
    c.nearest = k;
  }
  if (c.nearest < 0) return c;
  c.joined = 1u << c.nearest;
  for (int step = 0; step < 3; ++step) {
    for (int axis = 0; axis < 3; ++axis) {
      uint crossing = c.joined & ~closed[axis];
      c.joined |= ((crossing & LOW_CORNERS[axis]) << (1 << axis)) | ((crossing & ~LOW_CORNERS[axis]) >> (1 << axis));
    }
  }
  best = 1e30;
  for (int k = 0; k < 8; ++k) {
    vec3 d = vec3(corner_cell(c, k)) + 0.5 - around;
    if (((c.joined & unhidden) >> k & 1u) == 0u || dot(d, d) >= best) continue;
    best = dot(d, d);
    c.nearest = k;
  }
  return c;
}

// The cell that sees a point best, or the one that it lies in.
ivec3 seeing_cell(vec3 point, vec3 normal) {
  SeeingCells c = seeing_cells(point + 0.5 * normal, point + 2.0 * HIDDEN_DEPTH * normal, normal);
  return c.nearest >= 0 ? corner_cell(c, c.nearest) : ivec3(floor(point));
}

#endif
