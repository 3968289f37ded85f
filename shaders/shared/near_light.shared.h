// Sub-lights of virtual lights, which light what is near them.
#ifndef VOLGI_NEAR_LIGHT_SHARED_H
#define VOLGI_NEAR_LIGHT_SHARED_H
#include "shared/base.shared.h"
SHARED_BEGIN

// A virtual light is four coarse sub-lights, each of them four fine ones: neighbours on the curve of its source's
// samples.
#define COARSE_SUBLIGHTS 4
#define FINE_SUBLIGHTS 16
#define SUBLIGHTS_PER_LIGHT (COARSE_SUBLIGHTS + FINE_SUBLIGHTS)  // coarse ones first

// std430, 32 bytes. As VirtualLight.
struct SubLight {
  vec3 position;
  float area_m2;
  vec3 flux;
  uint normal;  // octahedral, two times 16 bits
};
#ifdef __cplusplus
static_assert(sizeof(SubLight) == 32 && offsetof(SubLight, flux) == 16);
#endif

// What is near a light. std430, 48 bytes.
struct NearLight {
  vec3 position;
  float area_m2;
  vec3 normal;
  float rise_m;    // smallest height over the light's plane of a point that any of its sub-lights lights
  float spread_m;  // of its sub-lights around its position
  float unused_0, unused_1, unused_2;
};
#ifdef __cplusplus
static_assert(sizeof(NearLight) == 48 && offsetof(NearLight, spread_m) == 32);
#endif

// Share of a light's irradiance that comes from itself and not from what it consists of: 0 up to a squared distance of
// `zone` areas, 1 from twice that on, and linear between in
// @param nearness  disk_nearness() of the light.
SHARED_FUNCTION float far_share(float nearness, float zone) {
  const float pi = 3.14159265f;
  float none = zone / (pi * zone + 1.0f);
  float all = 2.0f * zone / (2.0f * pi * zone + 1.0f);
  return zone > 0.0f ? clamp((nearness - none) / (all - none), 0.0f, 1.0f) : 1.0f;
}

SHARED_END
#endif
