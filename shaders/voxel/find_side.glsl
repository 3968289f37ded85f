// Which sides stand for a point of a surface.
#include "voxel/cell_sides.glsl"
#include "voxel/grid_block.glsl"
#include "voxel/open_way.glsl"
#include "voxel/seeing_cells.glsl"
#include "voxel/sides.glsl"

// Whether a surface whose plane passes the column's centre at `depth` lies behind the one that the side shows, as a floor
// does under a carpet: by more than the two planes can part within the half diagonal of a face (0.71 cells) when they are
// one bent surface. Layers nearer than 0.02 cells count as one: their areas add up.
bool behind_side(Side side, vec3 normal, int axis, float depth) {
  float cosine = clamp(dot(side.normal, normal), 0.1, 1.0);
  float bend = sqrt(1.0 - cosine * cosine) / cosine;
  return (side.depth - depth) * side.normal[axis] > 0.02 + 0.75 * bend;
}

bool hidden_from_cell(ivec3 cell, uvec2 own_sides, vec3 point, vec3 normal) {
  uint count = count_bits(own_sides.y & 63u);
  for (uint s = own_sides.x; s < own_sides.x + count; ++s) {
    if (side_hides(sides[s], cell, point, normal)) return true;
  }
  return false;
}

// The sides of `axis` that a surface point (cell units) may belong to: the surface, continued as a plane to the centre of
// the point's column, blocks one face there. Where the surface ends before the centre, the nearest columns are asked.
// x: the first whose normal is alike, y: the first that faces the same way at all, of those before x; -1 for none.
// front: 1 or 0 for sides that show a triangle's front or back only; -1 for any, of cells that see the point: a cell whose centre
// is inside of a closed box has nothing of the light on the ground beside it. place_matters is set where another point
// of the plane in the same cell may get another answer.
ivec2 find_side(vec3 point, vec3 normal, int axis, int front, ivec3 own, bool at_rim,
                inout bool place_matters) {
  int b = axis_b(axis);
  int c = axis_c(axis);
  int up = normal[axis] > 0.0 ? 1 : 0;
  int face = 2 * axis + 1 - up;
  bool below = falls_below_centre(normal, axis);
  ivec2 found = ivec2(-1);
  for (int k = 0; k < 27 && found.x < 0; ++k) {
    int ring = k / 3;
    int step = k - 3 * ring;
    int place = ring == 0 ? 4 : ring <= 4 ? ring - 1 : ring;  // own column first
    ivec3 cell = own;
    cell[b] += place % 3 - 1;
    cell[c] += place / 3 - 1;
    vec3 from_centre = point - vec3(cell) - 0.5;
    float depth = point[axis] + (normal[b] * from_centre[b] + normal[c] * from_centre[c]) / normal[axis];
    float away = abs(depth - point[axis]);
    if (away > 2.0 && away < 4.0) place_matters = true;
    if (away > 3.0) continue;
    cell[axis] = face_of_depth(depth, below) + (step == 0 ? 0 : step == 1 ? 1 : -1) - 1 + up;
    if (!cell_inside(grid, cell)) continue;
    uvec2 own_sides = cell_sides[cell_index(grid, cell)];
    if (!has_side(own_sides, face)) continue;
    int index = int(side_index(own_sides, face));
    if (front >= 0 && (sides[index].front != front || behind_side(sides[index], normal, axis, depth))) continue;
    if (front < 0 && (hidden_from_cell(cell, own_sides, point, normal) || !(at_rim || open_way(own, cell)))) continue;
    float cosine = dot(sides[index].normal, normal);
    if (cosine >= SIMILAR_NORMAL_COSINE) found.x = index;
    if (cosine >= 0.0 && found.y < 0 && !at_rim) found.y = index;
  }
  return found;
}

// A staircase of normal n has its area in the three face families as |n_x| : |n_y| : |n_z|; so goes what is at the point.
// Sides that merely face the same way count where no family has one that is alike. Weights sum to 1, or to 0 where no side
// is found. `point` in cell units.
void sides_of_cell_point(vec3 point, vec3 normal, int front, out ivec3 targets, out vec3 weights,
                         inout bool place_matters) {
  ivec3 alike = ivec3(-1);
  ivec3 facing = ivec3(-1);
  ivec3 own = front < 0 ? seeing_cell(point, normal) : ivec3(floor(point));
  // What sees the point is outside: only its own surface can stand for it.
  bool at_rim = front < 0 && !cell_inside(grid, own);
  if (at_rim) own = ivec3(floor(point));
  for (int axis = 0; axis < 3; ++axis) {
    if (abs(normal[axis]) < 1e-3) continue;
    ivec2 found = find_side(point, normal, axis, front, own, at_rim, place_matters);
    alike[axis] = found.x;
    facing[axis] = found.y;
  }
  targets = any(greaterThanEqual(alike, ivec3(0))) ? alike : facing;
  weights = mix(vec3(0.0), abs(normal), greaterThanEqual(targets, ivec3(0)));
  weights /= max(weights.x + weights.y + weights.z, 1e-30);
}

void sides_of_point(vec3 world_position, vec3 normal, int front, out ivec3 targets, out vec3 weights) {
  bool place_matters = false;
  sides_of_cell_point(cell_from_world(grid, world_position), normal, front, targets, weights, place_matters);
}
