// Sides: what one cell sees on one of its six faces when a surface blocks it. conventions: "Volume quantities".
#ifndef VOLGI_SIDE_SHARED_H
#define VOLGI_SIDE_SHARED_H
#include "shared/base.shared.h"
SHARED_BEGIN

// std430, 64 bytes.
struct Side {
  vec3 normal;      // geometric, towards the cell that sees the side
  float coverage;   // tau: share of the face's power that is stopped
  vec3 albedo;
  float area_m2;    // A = tau h^2 / s
  vec3 radiosity;   // emitted: pi * L_e [W m^-2]
  float staircase;  // s = |n_x| + |n_y| + |n_z|
  int cell;         // offset of the cell that sees it
  int face;         // face of that cell
  float depth;      // of the surface along the face's axis, cell units
  float pad;
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

SHARED_FUNCTION float staircase_factor(vec3 normal) { return abs(normal.x) + abs(normal.y) + abs(normal.z); }
SHARED_FUNCTION float side_area(float coverage, float cell_size_m, float staircase) {
  return coverage * cell_size_m * cell_size_m / staircase;
}

// A tilted surface shows the grid a staircase s times its area, which also intercepts (s-1)/s of what it sends. With
// these three the net power is exactly A (B0 - (1-rho) E) (conventions; tests/propagation/side_test.cpp).
SHARED_FUNCTION vec3 side_sent_power(vec3 flux, vec3 albedo, float s) {  // flux = A * B0
  return s * flux / (1.0f + (s - 1.0f) * albedo);
}
SHARED_FUNCTION vec3 side_returned_fraction(vec3 albedo, float s) { return s * albedo / (1.0f + (s - 1.0f) * albedo); }
SHARED_FUNCTION vec3 side_irradiance(vec3 received_power, vec3 flux, vec3 albedo, float area_m2, float s) {
  return (received_power - (s - 1.0f) * flux) / (area_m2 * (1.0f + (s - 1.0f) * albedo));
}

SHARED_END
#endif
