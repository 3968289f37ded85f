// Geometry stage of every pass over the scene's surfaces: a triangle becomes the rectangle of cell columns that it may
// touch, one fragment each. What it does to the lines of a column is decided exactly in lattice.glsl: rasterizers round
// vertices, and settle ties, in ways of their own.
#include "voxel/families.glsl"

layout(triangles) in;
layout(triangle_strip, max_vertices = 4) out;

flat in ivec3 c_vertex[3];
in vec2 c_uv0[3];
in vec2 c_uv1[3];
in vec4 c_color[3];
in vec3 c_normal[3];
flat in uint c_triangle[3];

flat out ivec3 v_vertex[3];
flat out vec2 v_uv0[3];
flat out vec2 v_uv1[3];
flat out vec4 v_color[3];
flat out vec3 v_normal;
flat out uint v_triangle;
flat out int v_axis;  // that the columns run along

// Columns low ... high of `axis`, both included; pixels are columns, the framebuffer is as large as the longest axis.
void emit_columns(int axis, ivec2 low, ivec2 high) {
  float per_column = 2.0 / float(max(max(grid.cells.x, grid.cells.y), grid.cells.z));
  for (int corner = 0; corner < 4; ++corner) {
    vec2 at = vec2((corner & 1) == 0 ? low.x : high.x + 1, (corner & 2) == 0 ? low.y : high.y + 1);
    gl_Position = vec4(per_column * at - 1.0, 0.5, 1.0);
    v_vertex = c_vertex;
    v_uv0 = c_uv0;
    v_uv1 = c_uv1;
    v_color = c_color;
    v_normal = c_normal[0];
    v_triangle = c_triangle[0];
    v_axis = axis;
    EmitVertex();
  }
  EndPrimitive();
}

ivec3 lowest() { return min(min(c_vertex[0], c_vertex[1]), c_vertex[2]); }
ivec3 highest() { return max(max(c_vertex[0], c_vertex[1]), c_vertex[2]); }

// The columns of `axis` in which a line of the fine lattice may meet the triangle. Most triangles of a detailed mesh meet
// none.
void emit_lines(int axis) {
  ivec3 first = in_family(max(first_line(lowest()), 0), axis);
  ivec3 last = in_family(min(last_line(highest()), 3 * grid.cells - 1), axis);
  if (first.y > last.y || first.z > last.z) return;
  emit_columns(axis, first.yz / 3, last.yz / 3);
}
