#version 450 core
// One layer of any texture as colours.
// Set by the program: VIEWED_SAMPLER, the sampler's type; LAYERED, where texels have three coordinates.
#include "screen/views/finite.glsl"
#include "screen/views/slots.shared.h"
#include "screen/views/view_modes.shared.h"
#include "shared/color_maps.shared.h"
#include "shared/tone_map.shared.h"

#ifndef VIEWED_SAMPLER
#define VIEWED_SAMPLER sampler2D
#endif
layout(binding = VIEWED_TEXTURE_UNIT) uniform VIEWED_SAMPLER viewed;
uniform int layer;
uniform vec2 first_pixel;       // of the texture, in the picture
uniform vec2 texels_per_pixel;  // along x and y
uniform vec2 range;
uniform int log_scale;
uniform int channel;
uniform int encode;

layout(location = 0) out vec4 display;

vec4 fetch(ivec2 texel) {
#ifdef LAYERED
  return vec4(texelFetch(viewed, ivec3(texel, layer), 0));
#else
  return vec4(texelFetch(viewed, texel, 0));
#endif
}

float in_range(float v) {
  if (log_scale == 0) return (v - range.x) / (range.y - range.x);
  return v > 0.0 ? log(v / range.x) / log(range.y / range.x) : 0.0;
}

vec3 color_of(vec3 v) {
  vec3 t = clamp(vec3(in_range(v.r), in_range(v.g), in_range(v.b)), 0.0, 1.0);
  return encode != 0 ? srgb_encode(t) : t;
}

void main() {
  ivec2 texel = ivec2(floor((gl_FragCoord.xy - first_pixel) * texels_per_pixel));
  display = vec4(NOTHING_COLOR, 1.0);
  if (any(lessThan(texel, ivec2(0))) || any(greaterThanEqual(texel, textureSize(viewed, 0).xy))) return;
  vec4 texels = fetch(texel);
  vec3 v = texels.rgb;
  if (channel == VIEW_LENGTH) v = vec3(length(texels.rgb));
  if (channel >= VIEW_RED && channel <= VIEW_ALPHA) v = vec3(texels[channel - VIEW_RED]);
  if (is_nan(v.r) || is_nan(v.g) || is_nan(v.b))
    display.rgb = NAN_COLOR;
  else if (is_infinite(v.r) || is_infinite(v.g) || is_infinite(v.b))
    display.rgb = INFINITY_COLOR;
  else
    display.rgb = channel == VIEW_RGB ? color_of(v) : viridis(in_range(v.r));
}
