#include <algorithm>
#include <cmath>

#include "core/image.h"

namespace volgi {

float srgb_encode(float linear) {
  if (linear <= 0.0031308f) return 12.92f * linear;
  return 1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f;
}

float srgb_decode(float encoded) {
  if (encoded <= 0.04045f) return encoded / 12.92f;
  return std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

glm::vec3 tone_map(glm::vec3 linear) {
  // NaN becomes black and infinity white: `v > 0` is false for NaN.
  for (int i = 0; i < 3; ++i) linear[i] = linear[i] > 0.0f ? std::min(linear[i], 1e30f) : 0.0f;
  constexpr float fresnel = 0.04f;
  constexpr float start = 0.8f - fresnel;
  constexpr float desaturation = 0.15f;

  const float smallest = std::min({linear.x, linear.y, linear.z});
  const float offset = smallest < 2.0f * fresnel ? smallest - 6.25f * smallest * smallest : fresnel;
  const glm::vec3 color = linear - offset;
  const float peak = std::max({color.x, color.y, color.z});
  if (peak < start) return color;

  constexpr float room = 1.0f - start;
  const float new_peak = 1.0f - room * room / (peak + room - start);
  const float white = 1.0f - 1.0f / (desaturation * (peak - new_peak) + 1.0f);
  return glm::mix(color * (new_peak / peak), glm::vec3(new_peak), white);
}

}  // namespace volgi
