#include "propagation/lobes/sh_lobes_walls.h"

#include <openvdb/tree/Tree.h>

#include <algorithm>

#include "shaders/shared/grid.shared.h"

namespace volgi {

namespace {

void close(LeafWalls& walls, int offset, int face) {
  walls.closed[size_t(offset >> 3)] |= std::uint64_t(1) << (8 * face + (offset & 7));
}

/// Leaves reach beyond a grid that is no multiple of 8: no light goes there.
void close_outside(LeafWalls& walls, const Grid& grid, glm::ivec3 lowest) {
  for (int offset = 0; offset < 512; ++offset) {
    const glm::ivec3 cell = lowest + glm::ivec3(offset >> 6, (offset >> 3) & 7, offset & 7);
    if (shared::cell_inside(grid, cell)) continue;
    for (int face = 0; face < 6; ++face) close(walls, offset, face);
  }
}

void add_sides(LeafWalls& walls, const VoxelGrid& voxels, const VoxelGrid::Leaf& leaf) {
  for (int face = 0; face < 6; ++face) {
    for (int row = 0; row < 64; ++row) {
      SideRow sides{std::uint8_t(face), std::uint8_t(row), 0, false, std::uint32_t(walls.sides.size())};
      for (int z = 0; z < 8; ++z) {
        const glm::uvec2 cell = VoxelGrid::unpack(leaf.buffer().data()[8 * row + z]);
        if (!shared::has_side(cell, face)) continue;
        const std::uint32_t side = shared::side_index(cell, face);
        close(walls, 8 * row + z, face);
        sides.cells = std::uint8_t(sides.cells | (1 << z));
        const shared::Side& s = voxels.sides()[side];
        sides.partly |= s.coverage < 1.0f;
        walls.sides.push_back(
            {side, std::min(s.coverage, 1.0f), shared::side_returned_fraction(s.albedo, s.area_m2, s.face_m2)});
      }
      if (sides.cells != 0) walls.rows.push_back(sides);
    }
  }
}

}  // namespace

std::vector<std::unique_ptr<LeafWalls>> collect_walls(const VoxelGrid& voxels, const LeafNumbers& numbers) {
  std::vector<std::unique_ptr<LeafWalls>> all(size_t(numbers.count()));
  for (int n = 0; n < numbers.count(); ++n) {
    if (!numbers.own(n)) continue;
    const glm::ivec3 block = numbers.block(n);
    const glm::ivec3 lowest = kLeafCells * block;
    const bool outside = glm::any(glm::greaterThan(lowest + kLeafCells, voxels.grid().cells));
    const VoxelGrid::Leaf* leaf = voxels.leaf(block);
    if (leaf == nullptr && !outside) continue;
    auto walls = std::make_unique<LeafWalls>();
    if (outside) close_outside(*walls, voxels.grid(), lowest);
    if (leaf != nullptr) add_sides(*walls, voxels, *leaf);
    for (size_t row = 0; row < walls->closed.size(); ++row) {
      if (walls->closed[row] != 0) walls->walled_rows |= std::uint64_t(3) << (row & ~size_t(1));
    }
    all[size_t(n)] = std::move(walls);
  }
  return all;
}

}  // namespace volgi
