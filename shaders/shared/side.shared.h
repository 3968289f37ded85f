// Sides: what one cell sees on one of its six faces when a surface blocks it. docs/conventions.md#volume-quantities.
#ifndef VOLGI_SIDE_SHARED_H
#define VOLGI_SIDE_SHARED_H
#include "shared/base.shared.h"
SHARED_BEGIN

// std430, 64 bytes.
struct Side {
  vec3 normal;     // geometric, towards the cell that sees the side
  float coverage;  // tau: share of the face's power that is stopped
  vec3 albedo;
  float area_m2;   // A: of the surface that the side stands for; tau h^2 / s on a plane (voxel/side_area)
  vec3 radiosity;  // emitted: pi * L_e [W m^-2]
  float face_m2;   // m = tau h^2: what the side shows to the grid
  int cell;        // offset of the cell that sees it
  int face;        // face of that cell
  float depth;     // of the surface along the face's axis, cell units
  int front;       // 1 when the cell sees the triangle's front, else 0
};
#ifdef __cplusplus
static_assert(sizeof(Side) == 64 && offsetof(Side, radiosity) == 32 && offsetof(Side, cell) == 48);
#endif

// Cells know their sides by one uvec2: x the offset of the first side, y a bit for each face that has a side (bits 0-5)
// and a bit for each that stops everything (bits 8-13).
SHARED_FUNCTION bool has_side(uvec2 cell_sides, int face) { return ((cell_sides.y >> face) & 1u) != 0u; }
SHARED_FUNCTION bool is_opaque(uvec2 cell_sides, int face) { return ((cell_sides.y >> (face + 8)) & 1u) != 0u; }
SHARED_FUNCTION uint count_bits(uint v) {
#ifdef __cplusplus
  return uint(__builtin_popcount(v));
#else
  return uint(bitCount(v));
#endif
}
SHARED_FUNCTION uint side_index(uvec2 cell_sides, int face) {
  return cell_sides.x + count_bits(cell_sides.y & ((1u << face) - 1u));
}

// Sides whose normals are within 45 degrees of each other may show one surface.
#define SIMILAR_NORMAL_COSINE 0.70710678f

// How far a point (cell units) lies in front of the surface that a side of `cell` shows.
SHARED_FUNCTION float height_over_side(Side side, ivec3 cell, vec3 point) {
  vec3 on_surface = vec3(cell) + 0.5f;
  on_surface[side.face >> 1] = side.depth;
  return dot(point - on_surface, side.normal);
}
// Whether a side hides a point of a surface of that normal from the cell that sees the side: the point lies behind it,
// by more than two layers that count as one; where normals are alike also by more than the two can part within the half
// diagonal of a face when they are one bent surface. Sides that let light pass do not hide.
#define HIDDEN_DEPTH 0.02f
#define HIDDEN_BEND 0.75f
SHARED_FUNCTION bool side_hides(Side side, ivec3 cell, vec3 point, vec3 normal) {
  float height = height_over_side(side, cell, point);
  if (side.coverage < 1.0f || height >= -HIDDEN_DEPTH) return false;
  float cosine = dot(side.normal, normal);
  if (cosine < SIMILAR_NORMAL_COSINE) return true;
  return height < -HIDDEN_DEPTH - HIDDEN_BEND * sqrt(max(1.0f - cosine * cosine, 0.0f)) / cosine;
}
// Of cells that see a point of a surface (voxel/seeing_cells.h), in cells.
#define SEEING_FIRST 4.0f    // more than the squared distances of eight cells differ by
#define SEEING_BEHIND 0.05f  // a surface may run through the centres of those that see it

// Of staircase factors: as far in front of a surface, in cells, as the cell that sees it has its centre; less a little,
// so that a wall on the grid's rim looks out of the grid and a cell behind it does not reach in front, despite
// rounding.
#define DEPOSIT_REACH 0.49f
#define DEPOSIT_FIRST 8.0f  // more than scores differ by: two of cosines, and 2.5 sqrt(3) cells
#define DEPOSIT_SEEN 16.0f  // before these: cells from which nothing hides the point

SHARED_FUNCTION float staircase_factor(vec3 normal) { return abs(normal.x) + abs(normal.y) + abs(normal.z); }

// A tilted surface shows the grid a staircase m of s times its area A, which also intercepts (s-1)/s of what it sends;
// s = m/A. With these two the net power is exactly A (B0 - (1-rho) E) whatever s is, also where a side stands for
// more or less surface than its face because an edge is near (docs/theory.md#sides; tests/propagation/side_test.cpp).
SHARED_FUNCTION vec3 side_denominator(vec3 albedo, float area_m2, float face_m2) {
  return vec3(area_m2) + (face_m2 - area_m2) * albedo;
}
SHARED_FUNCTION vec3 side_sent_power(vec3 flux, vec3 albedo, float area_m2, float face_m2) {  // flux = A * B0
  return face_m2 * flux / side_denominator(albedo, area_m2, face_m2);
}
SHARED_FUNCTION vec3 side_returned_fraction(vec3 albedo, float area_m2, float face_m2) {
  return face_m2 * albedo / side_denominator(albedo, area_m2, face_m2);
}
// A staircase of normal n lights itself: its faces across `axis` have s (s-|n_axis|)/(s+1) of what the surface sends
// per area from the other faces, and s less that from the world. Treads of a slightly turned wall hardly see its steps,
// steps are half walled in. (Exchange between two families of faces in proportion to |n_a||n_b|; exact where one
// component is zero. Over the families the mean is s-1, and 1.)
SHARED_FUNCTION float staircase_own_share(vec3 normal, int axis) {
  float s = staircase_factor(normal);
  return s * (s - abs(normal[axis])) / (s + 1.0f);
}
SHARED_FUNCTION float staircase_world_share(vec3 normal, int axis) {
  return staircase_factor(normal) - staircase_own_share(normal, axis);
}
// Irradiance of the surface [W m^-2]. It belongs to the surface's plane, so the staircase here is that of its normal: a
// side near an edge that stands for more surface than its face is not darker for that. Can be negative on tilted
// surfaces. In means a side counts as side_weight().
SHARED_FUNCTION vec3 side_irradiance(vec3 received_power, vec3 flux, vec3 albedo, vec3 normal, int axis, float area_m2,
                                     float face_m2) {
  float own = staircase_own_share(normal, axis), world = staircase_world_share(normal, axis);
  return (received_power * (staircase_factor(normal) / face_m2) - own * flux / area_m2) / (world + own * albedo);
}
// Area times what it sees of the world: with E the mean weighted so, the net power of a plane's sides is A (B0 -
// (1-rho) E), exactly where it is black or E the same all over it.
SHARED_FUNCTION float side_weight(vec3 normal, int axis, float area_m2) {
  return area_m2 * staircase_world_share(normal, axis);
}
// A side stands for at least this part of a plane through its face. What a black side sends is flux * m/A: without a
// least A, flux put down where little surface is counted grows without bound; with it at most to 4 s times. It costs
// nothing measurable: furnaces are the same to seven digits, pictures of data/ to 0.5 % of their energy.
#define SIDE_MIN_FILL 0.25f

// Radiosity of a side from its flux: over its area, or over this part of a cell's face where that is smaller, as at the
// rim of a surface.
#define LEAST_SIDE_AREA 0.05f

SHARED_END
#endif
