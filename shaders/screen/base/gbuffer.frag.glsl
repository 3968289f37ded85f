#version 450 core
// What the camera sees at the centre of each pixel. Both normals are turned to the viewer's side of the triangle.
#include "shared/material.glsl"
#include "shared/octahedral.glsl"

uniform vec4 viewer;  // position and 1, or the direction towards an orthographic camera and 0

in vec3 position;
in vec3 shading_normal;
in vec2 uv0;
in vec2 uv1;
in vec4 color;
flat in vec3 geometric_normal;
flat in uint object_id;

layout(location = 0) out vec4 out_position;  // w = 1: there is geometry
layout(location = 1) out vec4 out_normals;   // octahedral: shading, geometric
layout(location = 2) out vec4 out_albedo;
layout(location = 3) out vec4 out_emission;  // radiance towards the viewer
layout(location = 4) out uint out_object_id;

void main() {
  vec4 albedo = material_albedo_alpha(uv0, uv1, color);
  if (!material_keeps(albedo.a, uvec3(gl_FragCoord.xy, object_id * 65599u + uint(gl_PrimitiveID)))) discard;
  bool front = dot(geometric_normal, viewer.xyz - position * viewer.w) >= 0.0;
  vec3 geometric = front ? geometric_normal : -geometric_normal;
  vec3 shading = length(shading_normal) > 0.0 ? normalize(shading_normal) : geometric_normal;
  if (dot(shading, geometric) < 0.0) shading = -shading;
  out_position = vec4(position, 1.0);
  out_normals = vec4(octahedral_encode(shading), octahedral_encode(geometric));
  out_albedo = vec4(albedo.rgb, 1.0);
  bool emits = front || material_double_sided != 0;
  out_emission = vec4(emits ? material_emission(uv0, uv1) : vec3(0.0), 1.0);
  out_object_id = object_id;
}
