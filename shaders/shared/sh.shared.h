// Spherical harmonics up to band 2 and what the SH schemes integrate: `conservative` the flux through a cell's six
// faces, lpv2009 over the faces of a neighbour, gaitatzes2010 over a 90-degree cone. Real, orthonormal, no
// Condon-Shortley sign; order 00, 1-1 (y), 10 (z), 11 (x), 2-2 (xy), 2-1 (yz), 20, 21 (xz), 22
// (docs/conventions.md#spherical-harmonics). Lobes here are coefficients of an intensity [W/sr] times sqrt(4 pi), so
// that the first number is the power [W] (before clamp_rescale; a rescaled lobe carries the sum of what its faces
// pass): I(d) is 1/(4 pi) times the sum of lobe_i and sh_basis_i(d). Order 1 is a vec4; order 2 adds a vec4 (xy, yz,
// 20, xz) and a float (22).
#ifndef VOLGI_SH_SHARED_H
#define VOLGI_SH_SHARED_H
#include "shared/base.shared.h"
#include "shared/sh_constants.shared.h"
SHARED_BEGIN

// Component of the lobe that belongs to an axis: x -> w, y -> y, z -> z.
SHARED_FUNCTION int sh_component(int axis) { return axis == 0 ? 3 : axis; }

// Power of the lobe through `face` (FLUX_* of sh_constants.shared.h); below FLUX_MIN_SHARE of the lobe's it can be
// negative: then nothing passes.
SHARED_FUNCTION float flux_power(vec4 lobe, int face) {
  return FLUX_00 * lobe.x + ((face & 1) != 0 ? FLUX_01 : -FLUX_01) * lobe[sh_component(face >> 1)];
}

// What really passes, lobe included.
SHARED_FUNCTION float flux_passed(vec4 lobe, int face) {
  float power = flux_power(lobe, face);
  return power > FLUX_MIN_SHARE * lobe.x ? power : 0.0f;
}

// The six powers, clamped, sum to at least the lobe's power; this rescales the lobe so that they sum to it exactly.
SHARED_FUNCTION float clamp_rescale(vec4 lobe) {
  float sum = 0.0f;
  for (int face = 0; face < 6; ++face) sum += flux_passed(lobe, face);
  return sum > 0.0f ? lobe.x / sum : 0.0f;
}

// What a surface on `face` of a cell sends into the cell: cosine-distributed radiance of power 1, as one sixth of
// isotropic light would pass there (furnace: six such lobes sum to the isotropic one).
SHARED_FUNCTION vec4 side_lobe(int face) {
  vec4 lobe = vec4(1.0f, 0.0f, 0.0f, 0.0f);
  lobe[sh_component(face >> 1)] = (face & 1) != 0 ? -6.0f * FLUX_10 : 6.0f * FLUX_10;
  return lobe;
}

// sqrt(4 pi) Y_lm in direction d: bands 0 and 1; 2-2 ... 21; 22.
SHARED_FUNCTION vec4 sh_basis_1(vec3 d) { return vec4(1.0f, SH_SQRT3 * d.y, SH_SQRT3 * d.z, SH_SQRT3 * d.x); }
SHARED_FUNCTION vec4 sh_basis_2(vec3 d) {
  return vec4(SH_SQRT15 * d.x * d.y, SH_SQRT15 * d.y * d.z, SH_SQRT5 * (1.5f * d.z * d.z - 0.5f),
              SH_SQRT15 * d.x * d.z);
}
SHARED_FUNCTION float sh_basis_22(vec3 d) { return 0.5f * SH_SQRT15 * (d.x * d.x - d.y * d.y); }

// Order 2.
struct Lobe9 {
  vec4 low;    // 00, y, z, x
  vec4 mid;    // xy, yz, 20, xz
  float high;  // 22
};

// The coefficients 20 and 22 (p) as those of (1.5 a^2 - 0.5) and (b^2 - c^2) about the axis a; b, c its next two,
// cyclic. A turn by 240 or 120 degrees; from_axis is the way back.
SHARED_FUNCTION vec2 about_axis(vec2 p, int axis) {
  if (axis == 2) return p;
  float s = axis == 0 ? SH_HALF_SQRT3 : -SH_HALF_SQRT3;
  return vec2(-0.5f * p.x + s * p.y, -s * p.x - 0.5f * p.y);
}
SHARED_FUNCTION vec2 from_axis(vec2 p, int axis) {
  if (axis == 2) return p;
  float s = axis == 0 ? SH_HALF_SQRT3 : -SH_HALF_SQRT3;
  return vec2(-0.5f * p.x - s * p.y, s * p.x - 0.5f * p.y);
}

SHARED_FUNCTION float flux_power(Lobe9 lobe, int face) {
  int axis = face >> 1;
  float axial = lobe.low[sh_component(axis)];
  return FLUX_00 * lobe.low.x + ((face & 1) != 0 ? FLUX_01 : -FLUX_01) * axial +
         FLUX_02 * about_axis(vec2(lobe.mid.z, lobe.high), axis).x;
}

SHARED_FUNCTION float flux_passed(Lobe9 lobe, int face) {
  float power = flux_power(lobe, face);
  return power > FLUX_MIN_SHARE * lobe.low.x ? power : 0.0f;
}

SHARED_FUNCTION float clamp_rescale(Lobe9 lobe) {
  float sum = 0.0f;
  for (int face = 0; face < 6; ++face) sum += flux_passed(lobe, face);
  return sum > 0.0f ? lobe.low.x / sum : 0.0f;
}

// As side_lobe.
SHARED_FUNCTION Lobe9 side_lobe_9(int face) {
  int axis = face >> 1;
  Lobe9 lobe;
  lobe.low = vec4(1.0f, 0.0f, 0.0f, 0.0f);
  lobe.low[sh_component(axis)] = (face & 1) != 0 ? -6.0f * FLUX_10 : 6.0f * FLUX_10;
  vec2 p = from_axis(vec2(6.0f * FLUX_20, 0.0f), axis);
  lobe.mid = vec4(0.0f, 0.0f, p.x, 0.0f);
  lobe.high = p.y;
  return lobe;
}

// Cells of the papers' schemes hold the sum I of all that passed (lpv2009) or bounced (gaitatzes2010). Isotropic
// radiance L sends pi L h^2 through each face, 6 pi L h^2 through the cell, as 4 pi I: L = 2/(3 h^2) I, and a stored
// coefficient (times sqrt(4 pi)) becomes a radiance coefficient [W m^-2 sr^-1] by this factor.
SHARED_FUNCTION float radiance_from_lobe(float cell_size_m) {
  return 0.28209479f * 2.0f / (3.0f * cell_size_m * cell_size_m);
}

// gaitatzes2010 as we read it (docs/theory.md#papers). The lobe of a neighbour that comes in along `travel` (unit,
// along an axis) with power P is P times the cone's lobe about `travel`. In a cell of occupancy o the share 1 - o goes
// on as it is; the share o is mirrored on the axis nearest to the mean normal (the first of equals) if it heads into
// the surface. Where normals cancel (zero) light meets the surface from either side: it is mirrored on the axis it
// travels along. The mirrored lobe is of revolution about an axis, so mirroring is a change of `travel`.
SHARED_FUNCTION int nearest_axis(vec3 normal) {
  vec3 a = abs(normal);
  return a.x >= a.y && a.x >= a.z ? 0 : (a.y >= a.z ? 1 : 2);
}
// 1 if light that travels along `axis` by `sign` is turned back by a surface of mean normal `normal`, else 0.
SHARED_FUNCTION bool turned_back(vec3 normal, int axis, float sign) {
  if (normal == vec3(0.0f)) return true;
  return nearest_axis(normal) == axis && sign * normal[axis] < 0.0f;
}

SHARED_END
#endif
