#version 450 core
// What glass does to the light of a texel that lies behind it: blending multiplies by its tint. Beside that, the depth of
// the nearest pane, for whoever asks about points in front of it.
#define MATERIAL_TINTED
#include "shared/material.glsl"

in vec2 uv0;
in vec2 uv1;
in vec4 color;
flat in uint object_id;

layout(location = 0) out vec4 tint_and_depth;
layout(location = 1) out vec4 also_tint;

void main() {
  Pane pane = pane_of(material_base_as_written(uv0, uv1, color), 1);
  // By the same chance as in the pass before, which has drawn what this one leaves out.
  if (material_keeps(pane.stops, uvec3(gl_FragCoord.xy, object_id * 65599u + uint(gl_PrimitiveID)))) discard;
  tint_and_depth = vec4(pane.tint, gl_FragCoord.z);
  also_tint = tint_and_depth;
}
