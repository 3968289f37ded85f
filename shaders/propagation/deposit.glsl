// Light that leaves a surface at a point goes to the sides that stand for that surface, in fixed point, so that sums do
// not depend on order. Needs grid (uniform block 0), CellSides (3), Sides (4), and FluxFixed (12) below.
#include "shared/grid.shared.h"
#include "shared/side.shared.h"

layout(std140, binding = 0) uniform GridBlock { Grid grid; };
layout(std430, binding = 3) readonly buffer CellSides { uvec2 cell_sides[]; };
layout(std430, binding = 4) readonly buffer Sides { Side sides[]; };
layout(std430, binding = 12) buffer FluxFixed { uint flux_fixed[]; };  // 3 per side
layout(std430, binding = 13) buffer FluxLost { uint flux_lost[3]; };   // what found no side
uniform float flux_unit;  // [W]; all light of one source is below 2^31 of them

const float LIKE_NORMALS = 0.70710678;  // within 45 degrees

// The side of `axis` that a surface point (cell units) belongs to: the surface, continued as a plane to the centre of the
// point's column, blocks one face there. Where the surface ends before the centre, the nearest columns are asked.
int find_side(vec3 point, vec3 normal, int axis, float least_cosine) {
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
      if (dot(sides[index].normal, normal) >= least_cosine) return index;
    }
  }
  return -1;
}

// Any side of the 5^3 cells around that faces the same way at all, the nearest first by rings.
int find_any_side(vec3 point, vec3 normal) {
  ivec3 centre = ivec3(floor(point));
  int best = -1;
  float best_score = -1e30;
  for (int k = 0; k < 125; ++k) {
    ivec3 offset = ivec3(k % 5 - 2, (k / 5) % 5 - 2, k / 25 - 2);
    ivec3 cell = centre + offset;
    if (!cell_inside(grid, cell)) continue;
    uvec2 own_sides = cell_sides[cell_index(grid, cell)];
    for (int face = 0; face < 6; ++face) {
      if (!has_side(own_sides, face)) continue;
      int index = int(side_index(own_sides, face));
      float score = dot(sides[index].normal, normal) - length(vec3(cell) + 0.5 - point);
      if (score > best_score) {
        best_score = score;
        best = index;
      }
    }
  }
  return best;
}

void add_flux(int side, vec3 flux) {
  uvec3 units = uvec3(flux / flux_unit + 0.5);
  if (side < 0) {
    for (int band = 0; band < 3; ++band) atomicAdd(flux_lost[band], units[band]);
    return;
  }
  for (int band = 0; band < 3; ++band) {
    if (units[band] != 0u) atomicAdd(flux_fixed[3 * side + band], units[band]);
  }
}

// A staircase of normal n has its area in the three face families as |n_x| : |n_y| : |n_z|; so goes the flux.
void sides_of_point(vec3 world_position, vec3 normal, out ivec3 targets, out vec3 weights) {
  vec3 point = cell_from_world(grid, world_position);
  targets = ivec3(-1);
  weights = vec3(0.0);
  for (int attempt = 0; attempt < 2; ++attempt) {
    for (int axis = 0; axis < 3; ++axis) {
      float share = abs(normal[axis]);
      if (share < 1e-3) continue;
      targets[axis] = find_side(point, normal, axis, attempt == 0 ? LIKE_NORMALS : 0.0);
      if (targets[axis] >= 0) weights[axis] = share;
    }
    if (weights != vec3(0.0)) break;
  }
  if (weights == vec3(0.0)) {
    targets.x = find_any_side(point, normal);
    weights.x = 1.0;
  }
  weights /= weights.x + weights.y + weights.z;
}
