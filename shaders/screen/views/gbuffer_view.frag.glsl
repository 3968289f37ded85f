#version 450 core
// What the camera sees, before any light.
#include "screen/base/gbuffer.glsl"
#include "screen/views/slots.shared.h"
#include "screen/views/view_modes.shared.h"
#include "shared/color_maps.shared.h"
#include "shared/octahedral.glsl"
#include "shared/tone_map.shared.h"

layout(binding = VIEWED_EMISSION_UNIT) uniform sampler2D emission_map;
layout(binding = VIEWED_OBJECT_ID_UNIT) uniform usampler2D object_id_map;
uniform int mode;
uniform vec4 depth_plane;  // [m]: dot(xyz, position) - w
uniform vec2 depth_range_m;
uniform float exposure;  // factor

layout(location = 0) out vec4 display;

const float CONTOURS = 16.0;  // over the range

// Darker just in front of each contour, so that slopes can be read.
vec3 depth_color(float depth_m) {
  float t = (depth_m - depth_range_m.x) / (depth_range_m.y - depth_range_m.x);
  return viridis(t) * (0.7 + 0.3 * fract(t * CONTOURS));
}

vec3 surface_color(ivec2 pixel, vec3 position) {
  vec4 normals = texelFetch(normal_map, pixel, 0);
  switch (mode) {
    case VIEW_ALBEDO:
      return srgb_encode(texelFetch(albedo_map, pixel, 0).rgb);
    case VIEW_SHADING_NORMAL:
      return 0.5 + 0.5 * octahedral_decode(normals.xy);
    case VIEW_GEOMETRIC_NORMAL:
      return 0.5 + 0.5 * octahedral_decode(normals.zw);
    case VIEW_DEPTH:
      return depth_color(dot(depth_plane.xyz, position) - depth_plane.w);
    default:
      return hashed_color(texelFetch(object_id_map, pixel, 0).r);
  }
}

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 position = texelFetch(position_map, pixel, 0);
  vec3 color = NOTHING_COLOR;
  if (mode == VIEW_EMISSION)  // of the sky as well
    color = display_from_linear(texelFetch(emission_map, pixel, 0).rgb * exposure);
  else if (position.w != 0.0)
    color = surface_color(pixel, position.xyz);
  display = vec4(color, 1.0);
}
