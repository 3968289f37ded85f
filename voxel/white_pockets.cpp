#include "voxel/white_pockets.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "shaders/voxel/white_pockets.shared.h"

namespace volgi {

namespace {

/// Bands in which light leaves each cell in the end, spread from those where it does at once. The cells of a block
/// without sides are all open to each other, and have one answer.
class Leaving {
 public:
  explicit Leaving(const VoxelGrid& voxels) : voxels_(voxels), blocks_(block_count()) {
    for (size_t b = 0; b < blocks_.size(); ++b) {
      if (voxels.leaf(block_coord(voxels.blocks(), int(b))) != nullptr) blocks_[b].cells = std::make_unique<Cells>();
    }
    for (const shared::Side& side : voxels.sides())
      add(shared::cell_coord(voxels.grid(), side.cell), shared::bands_below_white(side.albedo));
    const glm::ivec3 cells = voxels.grid().cells;
    for (int face = 0; face < 6; ++face) {
      const int axis = shared::face_axis(face), b = shared::axis_b(axis), c = shared::axis_c(axis);
      glm::ivec3 cell(shared::face_sign(face) < 0 ? 0 : cells[axis] - 1);
      for (cell[b] = 0; cell[b] < cells[b]; ++cell[b]) {
        for (cell[c] = 0; cell[c] < cells[c]; ++cell[c]) {
          if (!shared::is_opaque(voxels.cell_sides(cell), face)) add(cell, ALL_BANDS);
        }
      }
    }
    while (!changed_.empty()) spread(pop());
  }
  std::uint32_t bands(glm::ivec3 cell) const {
    const Block& block = blocks_[block_of(cell)];
    return block.cells ? (*block.cells)[size_t(leaf_offset(cell))] : block.all;
  }
  size_t cells_without_some() const {
    size_t count = 0;
    for (size_t b = 0; b < blocks_.size(); ++b) {
      const glm::ivec3 first = kLeafCells * block_coord(voxels_.blocks(), int(b)), end = end_of(first);
      glm::ivec3 c;
      for (c.z = first.z; c.z < end.z; ++c.z) {
        for (c.y = first.y; c.y < end.y; ++c.y) {
          for (c.x = first.x; c.x < end.x; ++c.x) count += bands(c) != ALL_BANDS;
        }
      }
    }
    return count;
  }

 private:
  using Cells = std::array<std::uint8_t, kLeafVolume>;  // by leaf_offset
  struct Block {
    std::uint8_t all = 0;          // of a block without sides
    std::unique_ptr<Cells> cells;  // of one with sides
  };

  size_t block_count() const {
    const glm::ivec3 n = voxels_.blocks();
    return size_t(n.x) * size_t(n.y) * size_t(n.z);
  }
  size_t block_of(glm::ivec3 cell) const { return size_t(block_index(voxels_.blocks(), cell >> kLeafShift)); }
  glm::ivec3 end_of(glm::ivec3 first) const { return glm::min(first + kLeafCells, voxels_.grid().cells); }

  void add(glm::ivec3 cell, std::uint32_t bands) {
    Block& block = blocks_[block_of(cell)];
    std::uint8_t& own = block.cells ? (*block.cells)[size_t(leaf_offset(cell))] : block.all;
    if ((bands & ~own) == 0) return;
    own = std::uint8_t(own | bands);
    changed_.push_back(cell);
  }
  glm::ivec3 pop() {
    const glm::ivec3 last = changed_.back();
    changed_.pop_back();
    return last;
  }
  void spread(glm::ivec3 cell) {
    if (!blocks_[block_of(cell)].cells) return spread_block(cell >> kLeafShift << kLeafShift, bands(cell));
    const glm::uvec2 sides = voxels_.cell_sides(cell);
    const std::uint32_t own = bands(cell);
    for (int face = 0; face < 6; ++face) {
      const glm::ivec3 next = cell + shared::face_step(face);
      if (shared::cell_inside(voxels_.grid(), next) && !shared::is_opaque(sides, face)) add(next, own);
    }
  }

  /// To the cells around a block without sides.
  void spread_block(glm::ivec3 first, std::uint32_t bands) {
    const glm::ivec3 end = end_of(first);
    for (int face = 0; face < 6; ++face) {
      const int axis = shared::face_axis(face), b = shared::axis_b(axis), c = shared::axis_c(axis);
      glm::ivec3 next = first;
      next[axis] = shared::face_sign(face) < 0 ? first[axis] - 1 : end[axis];
      if (!shared::cell_inside(voxels_.grid(), next)) continue;
      for (next[b] = first[b]; next[b] < end[b]; ++next[b]) {
        for (next[c] = first[c]; next[c] < end[c]; ++next[c]) add(next, bands);
      }
    }
  }

  const VoxelGrid& voxels_;
  std::vector<Block> blocks_;
  std::vector<glm::ivec3> changed_;  // whose neighbours have not been told; any cell of a block without sides
};

}  // namespace

size_t bound_white_pockets(VoxelGrid& voxels) {
  const Leaving leaving(voxels);
  for (shared::Side& side : voxels.mutable_sides()) {
    for (int band = 0; band < 3; ++band) {
      if ((leaving.bands(shared::cell_coord(voxels.grid(), side.cell)) >> band & 1u) == 0)
        side.albedo[band] = std::min(side.albedo[band], MAX_POCKET_ALBEDO);
    }
  }
  return leaving.cells_without_some();
}

bool may_have_white_pockets(float largest_albedo) { return largest_albedo >= WHITE_ALBEDO; }

}  // namespace volgi
