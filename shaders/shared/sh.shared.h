// Spherical harmonics up to band 1 and what the `conservative` scheme integrates over a cell's six 90-degree pyramids.
// Real, orthonormal, no Condon-Shortley sign; order 00, 1-1 (y), 10 (z), 11 (x) (conventions). A lobe here is a vec4 of
// coefficients times sqrt(4 pi), so that its first number is its power.
#ifndef VOLGI_SH_SHARED_H
#define VOLGI_SH_SHARED_H
#include "shared/base.shared.h"
SHARED_BEGIN

// Integrals over the pyramid |y|,|z| <= x (solid angle 4 pi/6), exact:
//   int x    = 2 sqrt2 atan(1/sqrt2)        = 1.74083950...
//   int x^2  = 2 pi/9 + 4 sqrt3/9           = 1.46793206...
//   int y^2  = (4 pi/6 - int x^2) / 2       = 0.31323152...
// Six pyramids tile the sphere: int x^2 + 2 int y^2 = 4 pi/6 (tests/propagation/sh_test.cpp).
// Transfer of a lobe cut at the pyramid: M = int Y_i Y_j; axis-axis, axis-constant and transverse elements.
const float PYRAMID_CONSTANT = 1.0f / 6.0f;
const float PYRAMID_AXIS = 0.23994378f;        // sqrt3/(4 pi) * int x
const float PYRAMID_AXIS_AXIS = 0.35044297f;   // 3/(4 pi) * int x^2
const float PYRAMID_TRANSVERSE = 0.07477852f;  // 3/(4 pi) * int y^2

// Component of the lobe that belongs to an axis: x -> w, y -> y, z -> z.
SHARED_FUNCTION int sh_component(int axis) { return axis == 0 ? 3 : axis; }

// Power of the lobe inside the pyramid of `face`; can be negative, then the caller passes nothing.
SHARED_FUNCTION float pyramid_power(vec4 lobe, int face) {
  float axial = lobe[sh_component(face >> 1)];
  return PYRAMID_CONSTANT * lobe.x + ((face & 1) != 0 ? PYRAMID_AXIS : -PYRAMID_AXIS) * axial;
}

// The six powers, clamped, sum to at least the lobe's power; this rescales the lobe so that they sum to it exactly.
SHARED_FUNCTION float clamp_rescale(vec4 lobe) {
  float c = PYRAMID_CONSTANT * lobe.x;
  vec3 a = PYRAMID_AXIS * vec3(lobe.y, lobe.z, lobe.w);
  vec3 lo = max(vec3(c) - a, vec3(0.0f));
  vec3 hi = max(vec3(c) + a, vec3(0.0f));
  float sum = lo.x + lo.y + lo.z + hi.x + hi.y + hi.z;
  return sum > 0.0f ? lobe.x / sum : 0.0f;
}

// What a surface on `face` of a cell sends into the cell: radiance uniform over the pyramid, as one sixth of isotropic
// light would pass there (furnace: six such lobes sum to the isotropic one).
SHARED_FUNCTION vec4 side_lobe(int face) {
  vec4 lobe = vec4(1.0f, 0.0f, 0.0f, 0.0f);
  lobe[sh_component(face >> 1)] = (face & 1) != 0 ? -6.0f * PYRAMID_AXIS : 6.0f * PYRAMID_AXIS;
  return lobe;
}

SHARED_END
#endif
