#version 450 core
// Radiance as a display shows it.
#include "screen/display/slots.shared.h"
#include "shared/tone_map.shared.h"

layout(binding = PRESENTED_RADIANCE_UNIT) uniform sampler2D radiance;
uniform float exposure;  // factor

layout(location = 0) out vec4 display;

void main() {
  vec3 linear = texelFetch(radiance, ivec2(gl_FragCoord.xy), 0).rgb;
  display = vec4(display_from_linear(linear * exposure), 1.0);
}
