// Which sides stand for a point of a surface. Needs grid, cell_sides and sides (declared here; storage 3 and 4).
#include "shared/grid.shared.h"
#include "shared/side.shared.h"

layout(std140, binding = 0) uniform GridBlock { Grid grid; };
layout(std430, binding = 3) readonly buffer CellSides { uvec2 cell_sides[]; };
layout(std430, binding = 4) readonly buffer Sides { Side sides[]; };

const float LIKE_NORMALS = 0.70710678;  // within 45 degrees

// Whether a surface whose plane passes the column's centre at `depth` lies behind the one that the side shows, as a floor
// does under a carpet: by more than the two planes can part within the half diagonal of a face (0.71 cells) when they are
// one bent surface. Layers nearer than 0.02 cells count as one: their areas add up.
bool behind_side(Side side, vec3 normal, int axis, float depth) {
  float cosine = clamp(dot(side.normal, normal), 0.1, 1.0);
  float bend = sqrt(1.0 - cosine * cosine) / cosine;
  return (side.depth - depth) * side.normal[axis] > 0.02 + 0.75 * bend;
}

// The side of `axis` that a surface point (cell units) belongs to: the surface, continued as a plane to the centre of the
// point's column, blocks one face there. Where the surface ends before the centre, the nearest columns are asked.
// front: 1 or 0 for sides that show a triangle's front or back only, -1 for any.
int find_side(vec3 point, vec3 normal, int axis, float least_cosine, int front) {
  int b = axis_b(axis);
  int c = axis_c(axis);
  bool positive = normal[axis] > 0.0;
  for (int ring = 0; ring < 9; ++ring) {
    int k = ring == 0 ? 4 : ring <= 4 ? ring - 1 : ring;  // own column first
    ivec3 column = ivec3(floor(point));
    column[b] += k % 3 - 1;
    column[c] += k / 3 - 1;
    float depth = point[axis] + (normal[b] * (point[b] - float(column[b]) - 0.5) + normal[c] * (point[c] - float(column[c]) - 0.5)) / normal[axis];
    if (abs(depth - point[axis]) > 3.0) continue;
    int i = face_of_depth(depth);
    for (int step = 0; step < 3; ++step) {
      ivec3 cell = column;
      cell[axis] = i + (step == 0 ? 0 : step == 1 ? 1 : -1) - (positive ? 0 : 1);
      if (!cell_inside(grid, cell)) continue;
      uvec2 own_sides = cell_sides[cell_index(grid, cell)];
      int face = 2 * axis + (positive ? 0 : 1);
      if (!has_side(own_sides, face)) continue;
      int index = int(side_index(own_sides, face));
      if (front >= 0 && (sides[index].front != front || behind_side(sides[index], normal, axis, depth))) continue;
      if (dot(sides[index].normal, normal) >= least_cosine) return index;
    }
  }
  return -1;
}

// A staircase of normal n has its area in the three face families as |n_x| : |n_y| : |n_z|; so goes what is at the point.
// Weights sum to 1, or to 0 where no side faces alike.
void sides_of_point(vec3 world_position, vec3 normal, int front, out ivec3 targets, out vec3 weights) {
  vec3 point = cell_from_world(grid, world_position);
  targets = ivec3(-1);
  weights = vec3(0.0);
  for (int attempt = 0; attempt < 2; ++attempt) {
    for (int axis = 0; axis < 3; ++axis) {
      float share = abs(normal[axis]);
      if (share < 1e-3) continue;
      targets[axis] = find_side(point, normal, axis, attempt == 0 ? LIKE_NORMALS : 0.0, front);
      if (targets[axis] >= 0) weights[axis] = share;
    }
    if (weights != vec3(0.0)) break;
  }
  weights /= max(weights.x + weights.y + weights.z, 1e-30);
}
