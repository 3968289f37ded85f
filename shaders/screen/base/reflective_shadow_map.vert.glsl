#version 450 core
layout(location = 0) in vec3 vertex_position;
layout(location = 2) in vec2 vertex_uv0;
layout(location = 3) in vec2 vertex_uv1;
layout(location = 4) in vec4 vertex_color;
layout(location = 5) in vec3 vertex_geometric_normal;
layout(location = 6) in uint vertex_object_id;

uniform mat4 clip_from_world;

out vec3 position;
out vec2 uv0;
out vec2 uv1;
out vec4 color;
flat out vec3 geometric_normal;
flat out uint object_id;

void main() {
  position = vertex_position;
  uv0 = vertex_uv0;
  uv1 = vertex_uv1;
  color = vertex_color;
  geometric_normal = vertex_geometric_normal;
  object_id = vertex_object_id;
  gl_Position = clip_from_world * vec4(vertex_position, 1.0);
}
