#version 450 core
// Every fragment stands for a piece of surface and adds it to the sides that show it, once for the cells in front of the
// triangle and once for those behind. Fixed point: sums do not depend on order.
#include "shared/material.glsl"
#include "voxel/find_side.glsl"

in vec2 v_uv0;
in vec2 v_uv1;
in vec4 v_color;
in vec3 v_position;
flat in vec3 v_normal;

uniform int axis;
uniform float samples_per_cell;  // along each of the two axes
layout(std430, binding = 0) buffer AreaFixed { uint area_fixed[]; };  // 2^-20 h^2

void add_area(int side, float area) { atomicAdd(area_fixed[side], uint(area * 1048576.0 + 0.5)); }

// The side that a single sheet shows to the cell behind it lies across the face; a closed body has another surface there.
int side_behind(Side side) {
  ivec3 cell = cell_coord(grid, side.cell) + face_step(side.face);
  if (!cell_inside(grid, cell)) return -1;
  uvec2 own_sides = cell_sides[cell_index(grid, cell)];
  if (!has_side(own_sides, opposite_face(side.face))) return -1;
  int behind = int(side_index(own_sides, opposite_face(side.face)));
  return sides[behind].front == 0 && dot(sides[behind].normal, side.normal) <= -LIKE_NORMALS ? behind : -1;
}

void main() {
  float stopped = material_coverage(material_albedo_alpha(v_uv0, v_uv1, v_color).a);
  if (stopped <= 0.0) discard;
  float area = stopped / (samples_per_cell * samples_per_cell * abs(v_normal[axis]));
  ivec3 targets;
  vec3 weights;
  sides_of_point(v_position, v_normal, 1, targets, weights);
  bool seen_from_front = weights != vec3(0.0);
  if (!seen_from_front) sides_of_point(v_position, -v_normal, 0, targets, weights);
  for (int a = 0; a < 3; ++a) {
    if (weights[a] == 0.0) continue;
    add_area(targets[a], weights[a] * area);
    int behind = seen_from_front ? side_behind(sides[targets[a]]) : -1;
    if (behind >= 0) add_area(behind, weights[a] * area);
  }
}
