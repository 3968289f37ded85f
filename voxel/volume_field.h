#pragma once
#include <openvdb/openvdb.h>

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

#include "voxel/vdb_summary.h"

namespace volgi {

/// The cells of a grid's active box, one value each, to look at: x fastest.
struct VolumeField {
  enum class Kind { number, colour, normal };
  enum class Held : std::uint8_t { none, number, no_number };  // inactive; finite; NaN or infinite

  std::string name, unit, description;
  Kind kind = Kind::number;
  openvdb::math::Transform::ConstPtr place;  // of the grid's own cells
  openvdb::Coord first;                      // the grid's cell at the lower corner of cell (0, 0, 0)
  int step = 1;                              // the grid's cells along an edge of one of these
  glm::ivec3 cells{0};
  std::uint64_t active_cells = 0;  // of the grid
  std::vector<glm::vec3> values;   // numbers in all three
  std::vector<Held> held;

  size_t index(glm::ivec3 cell) const {
    return size_t(cell.x) + size_t(cells.x) * (size_t(cell.y) + size_t(cells.y) * size_t(cell.z));
  }
  bool contains(glm::ivec3 cell) const {
    return glm::all(glm::greaterThanEqual(cell, glm::ivec3(0))) && glm::all(glm::lessThan(cell, cells));
  }
  /// Middle of a cell in the world [m].
  glm::dvec3 centre(glm::ivec3 cell) const;
};

/// Reads a grid. Where its box has more than `most_cells` cells, blocks of step^3 of them become one, with the mean of
/// those that are active and finite: a grid of any size can be looked at, and its active cells alone are visited.
/// @param summary  of the grid, with channels (numbers or 3-vectors, and active cells).
VolumeField volume_field(const openvdb::GridBase& grid, const GridSummary& summary,
                         std::uint64_t most_cells = std::uint64_t(1) << 24);

/// Radiance of light that travels towards a direction, from the spherical harmonics of `volgi export`: Σ c_lm Y_lm(d),
/// and 0 where the cut series is below.
/// @param bands  4 or 9, in the order of the names (docs/conventions.md#spherical-harmonics), of one box.
/// @param towards  length 1.
VolumeField radiance_field(std::span<const VolumeField> bands, glm::vec3 towards);
/// Names of the bands' grids, in their order.
inline constexpr std::array<const char*, 9> kBandNames{"sh_00",  "sh_1m1", "sh_10", "sh_11", "sh_2m2",
                                                       "sh_2m1", "sh_20",  "sh_21", "sh_22"};

/// What a field can be looked at by: "value" of a number; "all", "luminance", "red", "green", "blue"; "all", "x", "y",
/// "z".
std::span<const char* const> channels_of(VolumeField::Kind kind);

/// One number for each cell, and what these come to.
struct VolumeScalars {
  std::vector<float> values;
  std::uint64_t count = 0;  // of cells that hold a number
  double low = 0.0, high = 0.0, mean = 0.0;
  double most = 0.0;  // that 99.5 % are not above
};
/// @param channel  of channels_of(); of "all" a colour's luminance, a normal's x. @throws Error(usage) for another,
/// naming those that there are.
VolumeScalars scalars_of(const VolumeField& field, const std::string& channel);

}  // namespace volgi
