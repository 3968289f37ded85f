#version 450 core
// What the picture is multiplied by; with DEPTH the depths of its surfaces, pushed back.
#include "screen/base/gbuffer.glsl"
#include "screen/views/view_camera.glsl"
#include "shared/octahedral.glsl"

#ifdef DEPTH

uniform float slack_m;

const float LEAST_FACING = 0.1;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 surface = texelFetch(position_map, pixel, 0);
  if (surface.w == 0.0) discard;
  vec3 towards = to_viewer(surface.xyz);
  float facing = dot(octahedral_decode(texelFetch(normal_map, pixel, 0).zw), towards);
  // Across the surface: along the view that is the farther, the more one looks along the surface.
  vec4 clip = clip_from_world * vec4(surface.xyz - towards * (slack_m / max(facing, LEAST_FACING)), 1.0);
  gl_FragDepth = clip.z / clip.w;
}

#else

uniform float brightness;

layout(location = 0) out vec4 factor;

void main() { factor = vec4(vec3(brightness), 1.0); }

#endif
