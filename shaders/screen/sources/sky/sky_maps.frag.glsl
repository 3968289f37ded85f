#version 450 core
// What one part of the sky sees: depth and normal of the surface.
#define MATERIAL_TINTED
#include "shared/material.glsl"
#include "shared/octahedral.glsl"

uniform vec4 viewer;  // the direction towards the part, and 0

in vec3 position;
in vec2 uv0;
in vec2 uv1;
in vec4 color;
flat in vec3 geometric_normal;
flat in uint object_id;

// Bits of the depth, as the depth buffer has it; the geometric normal on the sky's side, octahedral, packed.
layout(location = 0) out uvec2 surface;

void main() {
  float alpha = material_base(uv0, uv1, color).a;
  if (!material_keeps(alpha, uvec3(gl_FragCoord.xy, object_id * 65599u + uint(gl_PrimitiveID)))) discard;
  bool front = dot(geometric_normal, viewer.xyz) >= 0.0;
  vec3 normal = front ? geometric_normal : -geometric_normal;
  surface = uvec2(floatBitsToUint(gl_FragCoord.z), packSnorm2x16(octahedral_encode(normal)));
}
