#pragma once
#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "shaders/shared/side.shared.h"
#include "voxel/grid.h"
#include "voxel/openvdb_fwd.h"
#include "voxel/part.h"

namespace volgi {

/// Blocks of 8^3 cells, the leaves of OpenVDB's trees; a cell's place in its leaf is z fastest, as OpenVDB has it.
constexpr int kLeafShift = 3;
constexpr int kLeafCells = 1 << kLeafShift;
constexpr size_t kLeafVolume = kLeafCells * kLeafCells * kLeafCells;
inline glm::ivec3 leaf_blocks(const Grid& grid) { return (grid.cells + (kLeafCells - 1)) / kLeafCells; }
inline int block_index(glm::ivec3 blocks, glm::ivec3 block) {  // x fastest, as cells
  return block.x + blocks.x * (block.y + blocks.y * block.z);
}
inline glm::ivec3 block_coord(glm::ivec3 blocks, int index) {
  const int row = index / blocks.x;
  return {index - row * blocks.x, row % blocks.y, row / blocks.y};
}
inline int leaf_offset(glm::ivec3 cell) {
  return ((cell.x & (kLeafCells - 1)) << 6) | ((cell.y & (kLeafCells - 1)) << 3) | (cell.z & (kLeafCells - 1));
}

/// Blocked faces and sides of a grid on the CPU; twin of VoxelGridGl. A sparse OpenVDB tree over the cells (index space
/// is cell coordinates) says which sides a cell has: the uvec2 of side.shared.h, x in the low and y in the high half of
/// an int64; leaves exist only where there are sides. Sides are a compact list, those of one cell beside each other in
/// the order of faces; cells may come in any order. Memory: 4 KiB a leaf, 64 bytes a side, 16 bytes a block.
///
/// A rank among several has the sides of its part of the blocks, first in the list, and behind them what it knows of
/// its neighbours' within the `held` blocks (voxel/ranks_voxels.h); cells are numbered as in the whole grid all the
/// same.
class VoxelGrid {
 public:
  using CellSidesTree = vdb::Tree<std::int64_t>;
  using Leaf = vdb::Leaf<std::int64_t>;

  VoxelGrid() : VoxelGrid(Grid{}, {}) {}
  /// @param sides  those of one cell beside each other, in the order of faces. Faces stop everything where coverage
  ///               is 1.
  VoxelGrid(const Grid& grid, std::vector<shared::Side> sides);
  /// The same where whoever made the sides has the leaves, one for each block with sides, null elsewhere; takes them.
  VoxelGrid(const Grid& grid, std::vector<shared::Side> sides, const std::vector<Leaf*>& leaves);
  /// A rank's: the leaves of `held`, the sides of the blocks of `part` first.
  VoxelGrid(const Grid& grid, std::vector<shared::Side> sides, const std::vector<Leaf*>& leaves, const BlockBox& held,
            const BlockBox& part, size_t part_sides);

  const Grid& grid() const { return grid_; }
  const std::vector<shared::Side>& sides() const { return sides_; }
  std::vector<shared::Side>& mutable_sides() { return sides_; }  // what does not change which faces have sides
  /// Without those of neighbours, which follow in sides().
  size_t side_count() const { return part_sides_; }
  const CellSidesTree& cell_sides_tree() const { return *tree_; }

  /// Leaf of a block, or null where no cell of the block has a side. Two loads.
  const Leaf* leaf(glm::ivec3 block) const { return leaves_[held_.index(block)]; }
  glm::ivec3 blocks() const { return blocks_; }
  const BlockBox& part() const { return part_; }
  const BlockBox& held() const { return held_; }
  /// (0, 0) for a cell without sides. The cell must lie inside the grid, and its block be held.
  glm::uvec2 cell_sides(glm::ivec3 cell) const {
    const std::int64_t* l = leaf_cells_[held_.index(cell >> kLeafShift)];
    return l == nullptr ? glm::uvec2(0) : unpack(l[leaf_offset(cell)]);
  }
  static glm::uvec2 unpack(std::int64_t v) { return {std::uint32_t(v), std::uint32_t(std::uint64_t(v) >> 32)}; }
  static std::int64_t pack(glm::uvec2 v) { return std::int64_t(std::uint64_t(v.x) | (std::uint64_t(v.y) << 32)); }

  size_t bytes() const;
  /// What bytes() will be of so many sides in so many leaves.
  static size_t bytes_for(const BlockBox& held, size_t sides, size_t leaves);
  static size_t bytes_for(const Grid& grid, size_t sides, size_t leaves) {
    return bytes_for(BlockBox{glm::ivec3(0), leaf_blocks(grid)}, sides, leaves);
  }

 private:
  void point_to_cells();

  Grid grid_{};
  glm::ivec3 blocks_{0};
  BlockBox held_, part_;
  std::vector<shared::Side> sides_;
  size_t part_sides_ = 0;
  std::shared_ptr<CellSidesTree> tree_;
  std::vector<const Leaf*> leaves_;              // by held block
  std::vector<const std::int64_t*> leaf_cells_;  // their buffers, without OpenVDB's question whether they are in memory
};

}  // namespace volgi
