// Vertex stage of every pass over the scene's surfaces: corners in steps of slice_vertex, the rest as it comes.
#include "voxel/grid_block.glsl"

layout(location = 0) in vec3 in_position;
layout(location = 2) in vec2 in_uv0;
layout(location = 3) in vec2 in_uv1;
layout(location = 4) in vec4 in_color;
layout(location = 5) in vec3 in_geometric_normal;

flat out ivec3 c_vertex;  // slice_vertex
out vec2 c_uv0;
out vec2 c_uv1;
out vec4 c_color;
out vec3 c_normal;
flat out uint c_triangle;

void main() {
  c_vertex = slice_vertex(cell_from_world(grid, in_position));
  c_uv0 = in_uv0;
  c_uv1 = in_uv1;
  c_color = in_color;
  c_normal = in_geometric_normal;
  c_triangle = uint(gl_VertexID) / 3u;
}
