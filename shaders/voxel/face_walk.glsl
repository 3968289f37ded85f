// A way through the volume from cell to cell, and the sides that it meets: what blocked faces hide, wherever the camera
// is (Amanatides and Woo 1987, "A Fast Voxel Traversal Algorithm").
#ifndef VOLGI_FACE_WALK_GLSL
#define VOLGI_FACE_WALK_GLSL
#include "voxel/grid_block.glsl"
#include "voxel/sides.glsl"
#include "voxel/slots.shared.h"

layout(binding = WALK_CELLS_UNIT) uniform usamplerBuffer walk_cells;  // CELL_SIDES_SLOT's, as texels

#define NO_SIDE 0xffffffffu
// Cells off its start's plane within which a side of like normal is that very surface: a straight way that leaves a
// plane does not come back to it, but to the staircase that the grid makes of it.
#define OWN_SURFACE_CELLS 0.75

struct FaceWalk {
  vec3 start, direction;  // cell units; the direction is unit
  vec3 normal;            // of the surface that it leaves
  float plane;            // dot(normal, point of that surface), cell units
  int cell;               // its offset; < 0 outside of the grid
  ivec3 left;             // cells to the grid's rim along each axis
  ivec3 stride, faces;    // from cell to cell; the faces that are left through
  vec3 next, across;      // way to the next face of each axis; from one to the one behind it
  float way;              // to the face that was met last
};

// @param point  on a surface of normal `normal`, in cell units. @param direction  unit, leaves its front.
FaceWalk begin_walk(vec3 point, vec3 normal, vec3 direction) {
  FaceWalk w;
  w.start = point + 0.02 * normal;
  w.direction = direction;
  w.normal = normal;
  w.plane = dot(normal, point);
  ivec3 cell = ivec3(floor(w.start));
  bvec3 up = greaterThanEqual(direction, vec3(0.0));
  ivec3 ahead = ivec3(up);
  w.across = 1.0 / max(abs(direction), vec3(1e-7));
  w.next = mix(w.start - vec3(cell), vec3(cell) + 1.0 - w.start, up) * w.across;
  w.left = mix(cell, grid.cells - 1 - cell, up);
  w.stride = (2 * ahead - 1) * ivec3(1, grid.cells.x, grid.cells.x * grid.cells.y);
  w.faces = ivec3(0, 2, 4) + ahead;
  w.cell = cell_inside(grid, cell) ? cell_index(grid, cell) : -1;
  w.way = 0.0;
  return w;
}

// What the way starts behind, or beside, it does not meet: within half a cell a point may be in a cell that is behind
// the surface which it is in front of. (Axes are chosen by masks: software rasterizers index vectors slowly.)
bool is_ahead(FaceWalk w, uint side, int cell, ivec3 along) {
  vec3 at = mix(vec3(cell_coord(grid, cell)) + 0.5, vec3(sides[side].depth), equal(along, ivec3(1)));
  vec3 normal = sides[side].normal;
  bool own = abs(dot(at, w.normal) - w.plane) < OWN_SURFACE_CELLS &&
             abs(dot(normal, w.normal)) >= SIMILAR_NORMAL_COSINE;
  return !own && dot(w.start - at, normal) > 0.0;
}

// Walks to the next face with a side, no farther than `most_way` cells. NO_SIDE: there is none on the way.
uint next_side(inout FaceWalk w, float most_way) {
  while (w.cell >= 0) {
    w.way = min(w.next.x, min(w.next.y, w.next.z));
    if (w.way > most_way) return NO_SIDE;
    ivec3 along = ivec3(lessThanEqual(w.next, vec3(w.way)));
    along.yz -= min(along.yz, along.xx);  // one of those that are met at once
    along.z -= min(along.z, along.y);
    uvec2 own = texelFetch(walk_cells, w.cell).xy;
    ivec3 lost = w.faces * along;
    int face = lost.x + lost.y + lost.z, from = w.cell;
    ivec3 by = w.stride * along;
    w.left -= along;
    w.cell = min(w.left.x, min(w.left.y, w.left.z)) < 0 ? -1 : w.cell + by.x + by.y + by.z;
    w.next += w.across * vec3(along);
    if (!has_side(own, face)) continue;
    uint side = side_index(own, face);
    if (is_ahead(w, side, from, along)) return side;
  }
  return NO_SIDE;
}

// Share of light that comes this far. A light's own body begins a cell before it.
float open_share(inout FaceWalk w, float most_way) {
  float left = 1.0;
  uint side = next_side(w, most_way);
  while (side != NO_SIDE && left > 0.02) {
    left *= 1.0 - sides[side].coverage;
    side = next_side(w, most_way);
  }
  return left > 0.02 ? left : 0.0;
}

#endif
