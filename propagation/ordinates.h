#pragma once
#include <glm/glm.hpp>
#include <vector>

namespace volgi {

/// Directions of the octant (+,+,+) of a discrete-ordinates quadrature; the other octants mirror them.
struct OrdinateSet {
  std::vector<glm::vec3> directions;  // unit
  std::vector<float> weights;         // [sr]; over all eight octants they sum to 4 pi
  /// t = sum of w_d d_x over the directions with d_x > 0 (pi for exact integration, by symmetry the same on all axes):
  /// a side sends the share w_d |d_axis| / t of its power into d, so that a furnace is exact.
  float t = 0.0f;
};

/// 8: (1,1,1)/sqrt3. 24: permutations of (0.267, 0.682, 0.682), normalised. 48 and 80: level-symmetric S6
/// and S8 (Lewis and Miller 1984, table 4-1). Never a direction along an axis: its light would not spread (techniques).
/// @throws Error(usage) for another number, naming these.
OrdinateSet ordinate_set(int directions);

/// The number of directions that goes with a grid where none is asked for: refining the grid at fixed directions makes
/// the answer worse (docs/theory.md#ordinates).
int directions_for_grid(glm::ivec3 cells);

}  // namespace volgi
