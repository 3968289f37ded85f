// Punctual lights: what C++ uploads, and their irradiance. KHR_lights_punctual; docs/conventions.md#radiometry.
#ifndef VOLGI_LIGHT_SHARED_H
#define VOLGI_LIGHT_SHARED_H
#include "shared/base.shared.h"
SHARED_BEGIN

#define LIGHT_POINT 0
#define LIGHT_SPOT 1
#define LIGHT_DIRECTIONAL 2

// std430, 64 bytes.
struct PunctualLight {
  vec3 position;
  int type;
  vec3 direction;     // unit, the way light travels
  float range_m;      // 0: unlimited
  vec3 intensity;     // W/sr, or W/m^2 for a directional light
  float spot_scale;   // glTF: 1 / max(0.001, cos inner - cos outer)
  float spot_offset;  // -cos outer * spot_scale
  float cos_outer;
  float outer_versine;  // 1 - cos outer, all of its digits
  float pad0;
};
#ifdef __cplusplus
static_assert(sizeof(PunctualLight) == 64 && offsetof(PunctualLight, intensity) == 32);
#endif

// Share of the on-axis intensity that a spot sends along `from_light` (unit). Cosines within a narrow cone are alike
// but for their last digits (1 % of the light of a quarter of a degree): there 1 - cos is half the chord squared.
#define SPOT_NARROW 1e-3f  // 1 - cos of 2.6 degrees
SHARED_FUNCTION float spot_falloff(PunctualLight light, vec3 from_light) {
  float t = dot(light.direction, from_light) * light.spot_scale + light.spot_offset;
  if (light.outer_versine < SPOT_NARROW) {
    vec3 chord = from_light - light.direction;
    t = (light.outer_versine - 0.5f * dot(chord, chord)) * light.spot_scale;
  }
  t = clamp(t, 0.0f, 1.0f);
  return t * t;
}

// Window of KHR_lights_punctual: 1 without a range, 0 from `range` on.
SHARED_FUNCTION float range_window(PunctualLight light, float distance) {
  if (light.range_m <= 0.0f) return 1.0f;
  float q = distance / light.range_m;
  return clamp(1.0f - q * q * q * q, 0.0f, 1.0f);
}

// Irradiance at `position` on a surface that faces the light (E without its cosine); to_light is unit.
SHARED_FUNCTION vec3 perpendicular_irradiance(PunctualLight light, vec3 position,
#ifdef __cplusplus
                                              vec3& to_light
#else
                                              out vec3 to_light
#endif
) {
  if (light.type == LIGHT_DIRECTIONAL) {
    to_light = -light.direction;
    return light.intensity;
  }
  vec3 d = light.position - position;
  float distance = length(d);
  to_light = d / max(distance, 1e-30f);
  float falloff = light.type == LIGHT_SPOT ? spot_falloff(light, -to_light) : 1.0f;
  return light.intensity * (falloff * range_window(light, distance) / max(distance * distance, 1e-30f));
}

SHARED_END
#endif
