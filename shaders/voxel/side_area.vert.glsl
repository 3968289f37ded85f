#version 450 core
// Area of the surface that every side stands for: the scene scan-converted again, four times finer, each triangle along
// the axis nearest to its normal (side_area.frag.glsl).
#include "shared/grid.shared.h"

layout(location = 0) in vec3 in_position;
layout(location = 2) in vec2 in_uv0;
layout(location = 3) in vec2 in_uv1;
layout(location = 4) in vec4 in_color;
layout(location = 5) in vec3 in_geometric_normal;

layout(std140, binding = 0) uniform GridBlock { Grid grid; };
uniform int axis;

out vec2 v_uv0;
out vec2 v_uv1;
out vec4 v_color;
out vec3 v_position;
flat out vec3 v_normal;

void main() {
  vec3 cell = cell_from_world(grid, in_position);
  vec3 a = abs(in_geometric_normal);
  int nearest = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
  int b = axis_b(axis);
  int c = axis_c(axis);
  gl_Position = vec4(2.0 * cell[b] / float(grid.cells[b]) - 1.0, 2.0 * cell[c] / float(grid.cells[c]) - 1.0, 0.5, 1.0);
  if (nearest != axis) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);  // all three corners: nothing is drawn
  v_uv0 = in_uv0;
  v_uv1 = in_uv1;
  v_color = in_color;
  v_position = in_position;
  v_normal = in_geometric_normal;
}
