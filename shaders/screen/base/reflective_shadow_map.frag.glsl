#version 450 core
// What a light sees in one layer of its map; the depth goes to the depth buffer. Dachsbacher and Stamminger 2005,
// "Reflective Shadow Maps"; we depart: position follows from depth, and flux from albedo and solid angle.
#define MATERIAL_TINTED
#include "shared/material.glsl"
#include "shared/octahedral.glsl"

uniform vec4 viewer;  // the light's position and 1, or the direction towards the sun and 0

in vec3 position;
in vec2 uv0;
in vec2 uv1;
in vec4 color;
flat in vec3 geometric_normal;
flat in uint object_id;

layout(location = 0) out vec2 out_normal;  // geometric, octahedral, on the light's side
layout(location = 1) out vec4 out_albedo;

void main() {
  vec4 albedo = material_albedo_alpha(uv0, uv1, color);
  if (!material_keeps(albedo.a, uvec3(gl_FragCoord.xy, object_id * 65599u + uint(gl_PrimitiveID)))) discard;
  bool front = dot(geometric_normal, viewer.xyz - position * viewer.w) >= 0.0;
  out_normal = octahedral_encode(front ? geometric_normal : -geometric_normal);
  out_albedo = vec4(albedo.rgb, 1.0);
}
