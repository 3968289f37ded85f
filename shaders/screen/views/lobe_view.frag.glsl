#version 450 core
#include "screen/views/view_camera.glsl"
#include "shared/luminance.glsl"
#include "shared/tone_map.shared.h"

in vec3 radiance;
in vec3 position;

uniform float exposure;  // factor

layout(location = 0) out vec4 display;

const vec3 NEGATIVE_COLOR = vec3(0.9, 0.1, 0.8);

void main() {
  vec3 normal = normalize(cross(dFdx(position), dFdy(position)));
  float shade = 0.55 + 0.45 * abs(dot(normal, to_viewer(position)));
  bool negative = luminance(radiance) < 0.0;
  display = vec4(shade * (negative ? NEGATIVE_COLOR : display_from_linear(radiance * exposure)), 1.0);
}
