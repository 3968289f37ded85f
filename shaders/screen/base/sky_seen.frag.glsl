#version 450 core
// Radiance of the sky where there is no surface. CPU twin: Sky::radiance in core/sky.cpp.
#include "screen/base/gbuffer.glsl"
#include "screen/base/sky_picture.glsl"

layout(binding = GBUFFER_UNITS) uniform sampler2D sky;  // latitude-longitude, row 0 is +Y
uniform vec3 forward;                                   // and to the right and upper edges of the picture
uniform vec3 right;
uniform vec3 up;
uniform float rotation_rad;

layout(location = 0) out vec4 radiance;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  if (texelFetch(position_map, pixel, 0).w != 0.0) discard;
  vec2 at = gl_FragCoord.xy / vec2(textureSize(position_map, 0)) * 2.0 - 1.0;
  vec3 d = normalize(forward + at.x * right + at.y * up);
  radiance = vec4(textureLod(sky, sky_uv(d, rotation_rad), 0.0).rgb, 1.0);
}
