// Negative lights: what surfaces seen by the camera should have stopped of the virtual lights behind them. Cochran and
// Steele 2007, section 3.3.
#ifndef VOLGI_NEGATIVE_LIGHT_SHARED_H
#define VOLGI_NEGATIVE_LIGHT_SHARED_H
#include "shared/base.shared.h"
SHARED_BEGIN

#define MAX_NEGATIVE_LIGHTS 1024  // one uniform block

// std140 and std430, 48 bytes. Irradiance to subtract at x: flux * (exponent + 1) / 2 * cos_x * cos_l^exponent /
// (pi d^2 + area); exponent 1 is a virtual light's.
struct NegativeLight {
  vec3 position;   // centred frame
  float area_m2;   // of the visible surface that the light stands for
  vec3 direction;  // unit, mean direction in which the stopped light would travel on
  float exponent;  // of the lobe around it, >= 1
  vec3 flux;       // power to take away [W], >= 0
  float pad0;
};
#ifdef __cplusplus
static_assert(sizeof(NegativeLight) == 48 && offsetof(NegativeLight, direction) == 16);
#endif

SHARED_END
#endif
