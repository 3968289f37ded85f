// The numbers of sh.shared.h, with where they come from. Apart from it because the CPU's vector kernels read it: it
// includes nothing.
#ifndef VOLGI_SH_CONSTANTS_SHARED_H
#define VOLGI_SH_CONSTANTS_SHARED_H
#ifdef __cplusplus
namespace volgi::shared {
#endif

const float SH_SQRT3 = 1.7320508f;
const float SH_SQRT5 = 2.2360680f;
const float SH_SQRT15 = 3.8729833f;
const float SH_HALF_SQRT3 = 0.86602540f;

// `conservative` (docs/theory.md#conservative). Lobes cut at the pyramids over a cell's faces ring. Cells are taken as
// holding radiance instead, and what leaves through a face is its exact flux there, |d_a| over the half sphere, which
// is smooth. A cell of edge h shows h^2 s to direction d, s = |d_x|+|d_y|+|d_z|, the mean of s is 3/2: a lobe I stands
// for the radiance L h^2 = 2/3 I, of power int s L h^2 = its first number. What comes in is projected so that int s Y_i
// is kept: divided by (1/4 pi) int s Y_i^2 = 3/2 (bands 0 and 1), 25/16 (xy, yz, xz), 45/32 (20, 22); no cross terms,
// by the cube's symmetry. With (1/4 pi) int_{z>0} z Y_i Y_j all elements of the transfer through face +z are:
//          00          10            20                            11        21 (xz)               22       2-2 (xy)
//   00     1/6         sqrt3/9       sqrt5/24               11     1/8       sqrt5/15       22     1/9
//   10     sqrt3/9     1/4           2 sqrt15/45            21     8sqrt5/125  1/5          2-2              1/10
//   20     2 sqrt5/45  32 sqrt15/675 2/9
// (1-1 and 2-1 as 11 and 21.) Through face -z elements between even and odd powers of z change sign. The six sum to the
// identity (tests/propagation/sh_test.cpp). Order 1 takes the block of bands 0 and 1.
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
const float FLUX_TWIN = 0.11111111f;  // x^2 - y^2
const float FLUX_DIAGONAL = 0.1f;     // xy
// A face passes nothing below this part of the lobe's power. The power behind what a single side sends (order 2) or
// behind what of it has crossed a face sideways (order 1: 1/6 1/6 - sqrt3/9 1/8 2/sqrt3) is exactly zero but what would
// be handed on with it is not: rounding must not decide. 2^-16: above rounding, too little to see.
const float FLUX_MIN_SHARE = 1.0f / 65536.0f;

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

// lpv2009: what the centre of a cell sees of the neighbour at +x, in cells: the far face, (3/2, 0, 0) and half edge
// 1/2, has 4 asin((1/4) / (1/4 + 9/4)); the four side faces, centres (1, +-1/2, 0) and (1, 0, +-1/2), share what
// remains of the near face's 4 pi/6: pi/6 - asin(1/10) each.
const float LPV_FAR_SOLID_ANGLE = 0.40066968f;   // 4 asin(1/10) [sr]
const float LPV_SIDE_SOLID_ANGLE = 0.42343135f;  // pi/6 - asin(1/10) [sr]
const float LPV_SIDE_ALONG = 0.89442719f;        // direction to a side face's centre: (2, 1, 0) / sqrt(5)
const float LPV_SIDE_ACROSS = 0.44721360f;

#ifdef __cplusplus
}  // namespace volgi::shared
#endif
#endif
