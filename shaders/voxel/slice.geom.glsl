#version 450 core
// The rectangle of columns around a triangle. Which of them it covers is decided exactly in slice.frag.glsl: rasterizers
// round vertices, and settle ties, in ways of their own.
#include "shared/grid.shared.h"

layout(triangles) in;
layout(triangle_strip, max_vertices = 4) out;

flat in ivec3 c_vertex[3];
in vec2 c_uv0[3];
in vec2 c_uv1[3];
in vec4 c_color[3];
in vec3 c_normal[3];
flat in uint c_triangle[3];

layout(std140, binding = 0) uniform GridBlock { Grid grid; };
uniform int axis;

flat out ivec3 v_vertex[3];
flat out vec2 v_uv0[3];
flat out vec2 v_uv1[3];
flat out vec4 v_color[3];
flat out vec3 v_normal;
flat out uint v_triangle;

void main() {
  const float margin = 1.0 / 16.0;  // rounding must not lose a centre on the rim
  vec3 low = vec3(min(min(c_vertex[0], c_vertex[1]), c_vertex[2])) / float(SLICE_STEPS) - margin;
  vec3 high = vec3(max(max(c_vertex[0], c_vertex[1]), c_vertex[2])) / float(SLICE_STEPS) + margin;
  int b = axis_b(axis);
  int c = axis_c(axis);
  // Most triangles of a detailed mesh cover no column at all.
  if (floor(low[b] + 0.5) == floor(high[b] + 0.5) || floor(low[c] + 0.5) == floor(high[c] + 0.5)) return;
  for (int corner = 0; corner < 4; ++corner) {
    float at_b = clamp((corner & 1) == 0 ? low[b] : high[b], -1.0, float(grid.cells[b] + 1));
    float at_c = clamp((corner & 2) == 0 ? low[c] : high[c], -1.0, float(grid.cells[c] + 1));
    gl_Position = vec4(2.0 * at_b / float(grid.cells[b]) - 1.0, 2.0 * at_c / float(grid.cells[c]) - 1.0, 0.5, 1.0);
    v_vertex = c_vertex;
    v_uv0 = c_uv0;
    v_uv1 = c_uv1;
    v_color = c_color;
    v_normal = c_normal[0];
    v_triangle = c_triangle[0];
    EmitVertex();
  }
  EndPrimitive();
}
