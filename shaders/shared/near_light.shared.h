// Parts of virtual lights, which light what is near them.
#ifndef VOLGI_NEAR_LIGHT_SHARED_H
#define VOLGI_NEAR_LIGHT_SHARED_H
#include "shared/base.shared.h"
SHARED_BEGIN

// A virtual light is four quarters, a quarter four parts: neighbours on the curve of its source's samples.
#define LIGHT_QUARTERS 4
#define LIGHT_PARTS 16
#define LIGHT_PIECES (LIGHT_QUARTERS + LIGHT_PARTS)  // quarters first

// std430, 32 bytes. As VirtualLight.
struct LightPiece {
  vec3 position;
  float area_m2;
  vec3 flux;
  uint normal;  // octahedral, two times 16 bits
};
#ifdef __cplusplus
static_assert(sizeof(LightPiece) == 32 && offsetof(LightPiece, flux) == 16);
#endif

// What is near a light. std430, 48 bytes.
struct NearLight {
  vec3 position;
  float area_m2;
  vec3 normal;
  float rise_m;    // least height over the light's plane of a point that any of its pieces lights
  float spread_m;  // of its pieces around its position
  float unused_0, unused_1, unused_2;
};
#ifdef __cplusplus
static_assert(sizeof(NearLight) == 48 && offsetof(NearLight, spread_m) == 32);
#endif

// Share of a light's irradiance that comes from itself and not from what it consists of: 0 up to a squared distance of
// `zone` areas, 1 from twice that on, and linear between in
// @param form  squared / (pi squared + area): the disk-to-point form, times the squared distance.
SHARED_FUNCTION float far_share(float form, float zone) {
  const float pi = 3.14159265f;
  float none = zone / (pi * zone + 1.0f);
  float all = 2.0f * zone / (2.0f * pi * zone + 1.0f);
  return zone > 0.0f ? clamp((form - none) / (all - none), 0.0f, 1.0f) : 1.0f;
}

SHARED_END
#endif
