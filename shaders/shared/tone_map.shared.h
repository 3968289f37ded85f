// From linear light to what a display shows: Khronos PBR Neutral and the sRGB curve. core/image.h says what they do.
#ifndef VOLGI_TONE_MAP_SHARED_H
#define VOLGI_TONE_MAP_SHARED_H
#include "shared/base.shared.h"
SHARED_BEGIN
#ifdef __cplusplus
using glm::mix, glm::pow;
#endif

SHARED_FUNCTION float srgb_encode(float linear) {
  if (linear <= 0.0031308f) return 12.92f * linear;
  return 1.055f * pow(linear, 1.0f / 2.4f) - 0.055f;
}
SHARED_FUNCTION vec3 srgb_encode(vec3 linear) {
  return vec3(srgb_encode(linear.x), srgb_encode(linear.y), srgb_encode(linear.z));
}

SHARED_FUNCTION float srgb_decode(float encoded) {
  if (encoded <= 0.04045f) return encoded / 12.92f;
  return pow((encoded + 0.055f) / 1.055f, 2.4f);
}

// KhronosGroup/ToneMapping, PBR Neutral. Identity less an offset that grows to `fresnel`, up to `start`; then a
// shoulder that desaturates towards white.
SHARED_FUNCTION vec3 tone_map(vec3 linear) {
  // NaN becomes black and infinity white: `v > 0` is false for NaN.
  for (int i = 0; i < 3; ++i) linear[i] = linear[i] > 0.0f ? min(linear[i], 1e30f) : 0.0f;
  const float fresnel = 0.04f;
  const float start = 0.8f - fresnel;
  const float desaturation = 0.15f;

  float smallest = min(min(linear.x, linear.y), linear.z);
  float offset = smallest < 2.0f * fresnel ? smallest - 6.25f * smallest * smallest : fresnel;
  vec3 color = linear - offset;
  float peak = max(max(color.x, color.y), color.z);
  if (peak < start) return color;

  const float room = 1.0f - start;
  float new_peak = 1.0f - room * room / (peak + room - start);
  float white = 1.0f - 1.0f / (desaturation * (peak - new_peak) + 1.0f);
  return mix(color * (new_peak / peak), vec3(new_peak), white);
}

// What a display is sent for radiance, with the exposure's factor on it.
SHARED_FUNCTION vec3 display_from_linear(vec3 exposed) { return srgb_encode(tone_map(exposed)); }

SHARED_END
#endif
