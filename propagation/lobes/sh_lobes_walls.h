#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "propagation/lobes/sh_lobes.h"

namespace volgi {

/// Sides on one face of the 8 cells of a row along z.
struct SideRow {
  std::uint8_t face;
  std::uint8_t row;
  std::uint8_t cells;   // a bit for each cell that has a side there
  bool partly;          // some of them let light through
  std::uint32_t first;  // of LeafWalls::sides: one for each bit, in their order
};

/// What stands in the way of light in a leaf of 8^3 cells.
struct LeafWalls {
  struct SideThere {
    std::uint32_t side;
    float coverage;
    glm::vec3 returned;  // fraction of what it receives that it sends on
  };
  /// By row: byte f has a bit for each cell whose face f lets nothing through on the fast path: all faces with sides,
  /// and those between cells in and outside of the grid.
  std::array<std::uint64_t, 64> closed{};
  std::uint64_t walled_rows = 0;  // with something closed, and the other of their pair (2n, 2n + 1)
  std::vector<SideRow> rows;
  std::vector<SideThere> sides;
};

/// By number of leaf; null where nothing stands in the way.
std::vector<std::unique_ptr<LeafWalls>> collect_walls(const VoxelGrid& voxels, const LeafNumbers& numbers);

}  // namespace volgi
