#pragma once
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "propagation/scheme.h"

namespace volgi {

/// Directions of the octant (+,+,+) of a discrete-ordinates quadrature; the other octants mirror them.
struct OrdinateSet {
  std::vector<glm::vec3> directions;  // unit
  std::vector<float> weights;         // [sr]; over all eight octants they sum to 4 pi
  /// t = sum of w_d d_x over the directions with d_x > 0 (pi for exact integration, by symmetry the same on all axes):
  /// a side sends the share w_d |d_axis| / t of its power into d, so that a furnace is exact.
  float t = 0.0f;

  /// Share of a side's power, on each axis, that it sends into direction i.
  glm::vec3 emitted_share(size_t i) const { return directions[i] * (weights[i] / t); }
};

/// 8: (1,1,1)/sqrt3. 24: permutations of (0.267, 0.682, 0.682), normalised. 48 and 80: level-symmetric S6 and S8 (Lewis
/// and Miller 1984, table 4-1). 128: the octant halved twice along its great circles, 16 triangles; weight the area of
/// a triangle, direction its mean. 512: halved three times, 64 triangles; on the CPU. Never a direction along an axis:
/// its light would not spread (docs/theory.md#ordinates).
/// @throws Error(usage) for another number, naming these.
OrdinateSet ordinate_set(int directions);

/// How a cell hands on the power of one direction (of the octant +,+,+). Axes stand for faces: upwind faces where power
/// comes in, uniform over the face, downwind faces where it goes out.
struct CellTransfer {
  glm::mat3 share;  // share[in][out]; each share[in] sums to 1, and d[in] share[in][out] is symmetric: reciprocity
  glm::vec3 track;  // mean length of the way through the cell by upwind face, in cell edges; dot(d, track) is 1
};
/// Step: every share[in] is d / (d_x+d_y+d_z). Characteristic: the exact overlap of an upwind face, moved along d, with
/// the downwind ones. @param direction  unit, all components positive.
CellTransfer cell_transfer(Ordinates rule, glm::vec3 direction);

/// What one watt of direction `i` coming into a cell of edge h [m] by each upwind face adds to the cell's mean of
/// radiance times the direction's weight [m^-2]. A coefficient of the cell's radiance is then the sum over directions
/// and upwind faces of power, this, and Y_lm(d), where d is the direction that light travels: L_lm = (t/pi) / h^2 *
/// sum_d sum_in P_d,in track_d,in Y_lm(d). Isotropic radiance L has sh_00 = sqrt(4 pi) L and no other coefficient,
/// exactly: L sends (pi/t) w_d d_in L h^2 through each face, and dot(d, track) is 1.
glm::vec3 radiance_per_watt(const OrdinateSet& set, size_t i, Ordinates rule, float cell_size_m);

/// Directions and rule of a grid.
struct OrdinateChoice {
  int directions = 24;
  Ordinates rule = Ordinates::step;
};
/// Directions and rule as requested, else those that suit the grid: refining the grid at fixed directions makes the
/// answer worse, and sharper transfer shows few directions (docs/theory.md#ordinates). The step rule and 24 directions
/// up to 16 cells; then characteristic, with 48 directions up to 32 cells and 128 above. Where only one of the two is
/// requested, the other follows: characteristic with 48 directions or more, step with fewer.
OrdinateChoice choose_ordinates(glm::ivec3 cells, const SchemeOptions& options);
/// What carries the order of what sources send; none: the same as all orders (SchemeOptions::many_for_sources).
std::optional<OrdinateChoice> choose_source_ordinates(glm::ivec3 cells, const SchemeOptions& options);

/// The number of directions that suits a grid, where none is requested.
int directions_for_grid(glm::ivec3 cells);

}  // namespace volgi
