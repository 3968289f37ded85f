#version 450 core
// How much a picture is brighter than its reference. CPU twin: error_colors() of reference/error_map.cpp.
#include "screen/views/finite.glsl"
#include "screen/views/slots.shared.h"
#include "shared/color_maps.shared.h"

layout(binding = JUDGED_RADIANCE_UNIT) uniform sampler2D picture;
layout(binding = REFERENCE_RADIANCE_UNIT) uniform sampler2D reference;
uniform int relative;
uniform float range;  // of full red and full blue
uniform float floor_radiance;

layout(location = 0) out vec4 display;

float mean_of_bands(vec3 v) { return (v.r + v.g + v.b) / 3.0; }

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  float judged = mean_of_bands(texelFetch(picture, pixel, 0).rgb);
  float right = mean_of_bands(texelFetch(reference, pixel, 0).rgb);
  vec3 color = difference_color((judged - right) / ((relative != 0 ? right + floor_radiance : 1.0) * range));
  if (is_infinite(judged) || is_infinite(right)) color = INFINITY_COLOR;
  if (is_nan(judged) || is_nan(right)) color = NAN_COLOR;
  display = vec4(color, 1.0);
}
