#version 450 core
// One slicing pass of the 3-way voxelization (Gaitatzes 2010, Algorithm 1): the scene seen along one axis, a pixel for
// every column of cells, no depth test: fragments sort themselves into the faces that they block (slice.frag.glsl).
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
flat out vec3 v_normal;
flat out float v_plane;  // slice_plane
flat out float v_moved;  // how far that is from the triangle, along the normal, cell units
flat out uint v_triangle;

void main() {
  vec3 cell = cell_from_world(grid, in_position);
  int b = axis_b(axis);
  int c = axis_c(axis);
  vec3 vertex = slice_vertex(cell);
  gl_Position = vec4(2.0 * vertex[b] / float(grid.cells[b]) - 1.0, 2.0 * vertex[c] / float(grid.cells[c]) - 1.0, 0.5, 1.0);
  v_uv0 = in_uv0;
  v_uv1 = in_uv1;
  v_color = in_color;
  v_normal = in_geometric_normal;
  v_plane = slice_plane(in_geometric_normal, cell);
  v_moved = v_plane - dot(in_geometric_normal, cell);
  v_triangle = uint(gl_VertexID) / 3u;
}
