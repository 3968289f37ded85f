// Spherical harmonics up to band 2 and what the SH schemes integrate: `conservative` over a cell's six 90-degree
// pyramids, lpv2009 over the faces of a neighbour, gaitatzes2010 over a 90-degree cone. Real, orthonormal, no
// Condon-Shortley sign; order 00, 1-1 (y), 10 (z), 11 (x), 2-2 (xy), 2-1 (yz), 20, 21 (xz), 22 (conventions). Lobes here
// are coefficients of an intensity [W/sr] times sqrt(4 pi), so that the first number is the power [W]: I(d) is
// 1/(4 pi) times the sum of lobe_i and sh_basis_i(d). Order 1 is a vec4; order 2 adds a vec4 (xy, yz, 20, xz) and a
// float (22).
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

// sqrt(4 pi) Y_lm in direction d: bands 0 and 1; 2-2 ... 21; 22.
const float SH_SQRT3 = 1.7320508f;
const float SH_SQRT5 = 2.2360680f;
const float SH_SQRT15 = 3.8729833f;
SHARED_FUNCTION vec4 sh_basis_1(vec3 d) { return vec4(1.0f, SH_SQRT3 * d.y, SH_SQRT3 * d.z, SH_SQRT3 * d.x); }
SHARED_FUNCTION vec4 sh_basis_2(vec3 d) {
  return vec4(SH_SQRT15 * d.x * d.y, SH_SQRT15 * d.y * d.z, SH_SQRT5 * (1.5f * d.z * d.z - 0.5f),
              SH_SQRT15 * d.x * d.z);
}
SHARED_FUNCTION float sh_basis_22(vec3 d) { return 0.5f * SH_SQRT15 * (d.x * d.x - d.y * d.y); }

// `conservative` of order 2 (docs/theory.md#conservative). Cut at pyramids a lobe of nine coefficients rings. Cells are
// taken as holding radiance instead, and what leaves through a face is its exact flux there, |d_a| over the half sphere,
// which is smooth. A cell of edge h shows h^2 s to direction d, s = |d_x|+|d_y|+|d_z|, the mean of s is 3/2: a lobe I
// stands for the radiance L h^2 = 2/3 I, of power int s L h^2 = its first number. What comes in is projected so that
// int s Y_i is kept: divided by (1/4 pi) int s Y_i^2 = 3/2 (bands 0 and 1), 25/16 (xy, yz, xz), 45/32 (20, 22); no
// cross terms, by the cube's symmetry. With (1/4 pi) int_{z>0} z Y_i Y_j all elements of the transfer through face +z are:
//          00          10            20                            11        21 (xz)               22       2-2 (xy)
//   00     1/6         sqrt3/9       sqrt5/24               11     1/8       sqrt5/15       22     1/9
//   10     sqrt3/9     1/4           2 sqrt15/45            21     8sqrt5/125  1/5          2-2              1/10
//   20     2 sqrt5/45  32 sqrt15/675 2/9
// (1-1 and 2-1 as 11 and 21.) Through face -z elements between even and odd powers of z change sign. The six sum to the
// identity (tests/propagation/sh_test.cpp).
const float FLUX_00 = 0.16666667f;  // row, column: bands of what comes out and of what goes in, about the face's axis
const float FLUX_01 = 0.19245009f;
const float FLUX_02 = 0.09316950f;
const float FLUX_10 = 0.19245009f;
const float FLUX_11 = 0.25f;
const float FLUX_12 = 0.17213259f;
const float FLUX_20 = 0.09938080f;
const float FLUX_21 = 0.18360810f;
const float FLUX_22 = 0.22222222f;
const float FLUX_ACROSS_11 = 0.125f;  // 11 and 1-1; 21 and 2-1
const float FLUX_ACROSS_12 = 0.14907120f;
const float FLUX_ACROSS_21 = 0.14310835f;
const float FLUX_ACROSS_22 = 0.2f;
const float FLUX_TWIN = 0.11111111f;     // x^2 - y^2
const float FLUX_DIAGONAL = 0.1f;        // xy
const float SH_HALF_SQRT3 = 0.86602540f;

struct Lobe9 {
  vec4 low;   // 00, y, z, x
  vec4 mid;   // xy, yz, 20, xz
  float high; // 22
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

// Power of the lobe through `face`; can be negative, then the caller passes nothing.
SHARED_FUNCTION float flux_power(Lobe9 lobe, int face) {
  int axis = face >> 1;
  float axial = lobe.low[sh_component(axis)];
  return FLUX_00 * lobe.low.x + ((face & 1) != 0 ? FLUX_01 : -FLUX_01) * axial +
         FLUX_02 * about_axis(vec2(lobe.mid.z, lobe.high), axis).x;
}

// As clamp_rescale.
SHARED_FUNCTION float clamp_rescale_9(Lobe9 lobe) {
  float sum = 0.0f;
  for (int face = 0; face < 6; ++face) sum += max(flux_power(lobe, face), 0.0f);
  return sum > 0.0f ? lobe.low.x / sum : 0.0f;
}

// As side_lobe: cosine-distributed radiance of power 1, one sixth of isotropic light.
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

// A lobe of power 1 and of revolution about n has the coefficients z_l sqrt(4 pi) Y_lm(n) and the intensity
// 1/(4 pi) sum z_l (2l+1) P_l(cos), with z_0 = 1.
// Clamped cosine, max(cos, 0)/pi:                z_1 = 2/3                  z_2 = 1/4
// Cone of half angle a = 45 degrees, uniform:    z_1 = (1 + cos a)/2        z_2 = cos a (1 + cos a)/2
// times its share (1 - cos a)/2 of the sphere, sqrt(pi) sqrt(2l+1): the zonal coefficients that Gaitatzes 2010 names,
// sqrt(pi) (1 - cos a), sqrt(3 pi)/2 sin^2 a, and for band 2 sqrt(5 pi)/2 cos a sin^2 a.
const float COSINE_ZONAL_1 = 0.66666667f;
const float COSINE_ZONAL_2 = 0.25f;
const float CONE_SHARE = 0.14644661f;
const float CONE_ZONAL_1 = 0.85355339f;
const float CONE_ZONAL_2 = 0.60355339f;

// lpv2009: what the centre of a cell sees of the neighbour at +x, in cells: the far face, (3/2, 0, 0) and half edge 1/2,
// has 4 asin((1/4) / (1/4 + 9/4)); the four side faces, centres (1, +-1/2, 0) and (1, 0, +-1/2), share what remains of
// the near face's 4 pi/6: pi/6 - asin(1/10) each.
const float LPV_FAR_SOLID_ANGLE = 0.40066968f;   // 4 asin(1/10) [sr]
const float LPV_SIDE_SOLID_ANGLE = 0.42343135f;  // pi/6 - asin(1/10) [sr]
const float LPV_SIDE_ALONG = 0.89442719f;        // direction to a side face's centre: (2, 1, 0) / sqrt(5)
const float LPV_SIDE_ACROSS = 0.44721360f;

// Cells of the papers' schemes hold the sum I of all that passed (lpv2009) or bounced (gaitatzes2010). Isotropic
// radiance L sends pi L h^2 through each face, 6 pi L h^2 through the cell, as 4 pi I: L = 2/(3 h^2) I, and a stored
// coefficient (times sqrt(4 pi)) becomes a radiance coefficient [W m^-2 sr^-1] by this factor.
SHARED_FUNCTION float radiance_from_lobe(float cell_size_m) {
  return 0.28209479f * 2.0f / (3.0f * cell_size_m * cell_size_m);
}

// gaitatzes2010 as we read it (docs/theory.md#papers). The lobe of a neighbour that comes in along `travel` (unit, along
// an axis) with power P is P times the cone's lobe about `travel`. In a cell of occupancy o the share 1 - o goes on as it
// is; the share o is mirrored on the axis nearest to the mean normal (the first of equals) if it heads into the surface.
// Where normals cancel (zero) light meets the surface from either side: it is mirrored on the axis it travels along.
// The mirrored lobe is of revolution about an axis, so mirroring is a change of `travel`.
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
