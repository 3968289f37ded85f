#version 450 core
// A picture left of a column, its reference right of it.
#include "screen/views/slots.shared.h"
#include "shared/tone_map.shared.h"

layout(binding = JUDGED_RADIANCE_UNIT) uniform sampler2D picture;
layout(binding = REFERENCE_RADIANCE_UNIT) uniform sampler2D reference;
uniform int column;
uniform float exposure;  // factor

layout(location = 0) out vec4 display;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec3 radiance = pixel.x < column ? texelFetch(picture, pixel, 0).rgb : texelFetch(reference, pixel, 0).rgb;
  display = vec4(pixel.x == column ? vec3(1.0) : display_from_linear(radiance * exposure), 1.0);
}
