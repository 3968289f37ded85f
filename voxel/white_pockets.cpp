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
  Leaving(const VoxelGrid& voxels, const RanksOfVolume* ranks)
      : voxels_(voxels),
        first_(kLeafCells * voxels.part().first),
        last_(glm::min(kLeafCells * voxels.part().last, voxels.grid().cells)),
        blocks_(voxels.held().count()) {
    for (size_t b = 0; b < blocks_.size(); ++b) {
      if (voxels.leaf(voxels.held().block(b)) != nullptr) blocks_[b].cells = std::make_unique<Cells>();
    }
    for (size_t i = 0; i < voxels.side_count(); ++i) {
      const shared::Side& side = voxels.sides()[i];
      add(shared::cell_coord(voxels.grid(), side.cell), shared::bands_below_white(side.albedo));
    }
    for (int face = 0; face < 6; ++face) start_at_rim(face);
    do {
      while (!changed_.empty()) spread(pop());
    } while (ranks != nullptr && told_others(*ranks));
  }
  std::uint32_t bands(glm::ivec3 cell) const {
    const Block& block = blocks_[block_of(cell)];
    return block.cells ? (*block.cells)[size_t(leaf_offset(cell))] : block.all;
  }
  size_t cells_without_some() const {
    size_t count = 0;
    for (glm::ivec3 c = first_; c.z < last_.z; ++c.z) {
      for (c.y = first_.y; c.y < last_.y; ++c.y) {
        for (c.x = first_.x; c.x < last_.x; ++c.x) count += bands(c) != ALL_BANDS;
      }
    }
    return count;
  }

 private:
  struct Told {
    glm::ivec3 cell;
    std::uint32_t bands;
  };
  using Cells = std::array<std::uint8_t, kLeafVolume>;  // by leaf_offset
  struct Block {
    std::uint8_t all = 0;          // of a block without sides
    std::unique_ptr<Cells> cells;  // of one with sides
  };

  size_t block_of(glm::ivec3 cell) const { return voxels_.held().index(cell >> kLeafShift); }
  bool is_own(glm::ivec3 cell) const {
    return glm::all(glm::greaterThanEqual(cell, first_)) && glm::all(glm::lessThan(cell, last_));
  }
  void start_at_rim(int face) {
    const int axis = shared::face_axis(face), b = shared::axis_b(axis), c = shared::axis_c(axis);
    glm::ivec3 cell(shared::face_sign(face) < 0 ? 0 : voxels_.grid().cells[axis] - 1);
    for (cell[b] = first_[b]; cell[b] < last_[b]; ++cell[b]) {
      for (cell[c] = first_[c]; cell[c] < last_[c]; ++cell[c]) {
        if (is_own(cell) && !shared::is_opaque(voxels_.cell_sides(cell), face)) add(cell, ALL_BANDS);
      }
    }
  }
  /// What has reached cells beside other parts goes there. @return  whether any rank has learnt something.
  bool told_others(const RanksOfVolume& ranks) {
    std::vector<std::vector<Told>> to(size_t(ranks.ranks.count()));
    for (const Told& told : to_tell_) to[size_t(ranks.decomposition.owner(told.cell >> kLeafShift))].push_back(told);
    std::array<std::int64_t, 1> count{std::int64_t(to_tell_.size())};
    to_tell_.clear();
    for (const auto& from : exchange_values(ranks.ranks, to)) {
      for (const Told& told : from) add(told.cell, told.bands);
    }
    ranks.ranks.add(count);
    return count[0] > 0;
  }
  /// What reaches a cell: its neighbours, or the rank that has it, are still to be told.
  void add(glm::ivec3 cell, std::uint32_t bands) {
    Block& block = blocks_[block_of(cell)];
    std::uint8_t& own = block.cells ? (*block.cells)[size_t(leaf_offset(cell))] : block.all;
    if ((bands & ~own) == 0) return;
    own = std::uint8_t(own | bands);
    if (is_own(cell)) {
      changed_.push_back(cell);
    } else {
      to_tell_.push_back({cell, bands});
    }
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
    const glm::ivec3 end = glm::min(first + kLeafCells, voxels_.grid().cells);
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
  glm::ivec3 first_, last_;          // cells of the part
  std::vector<Block> blocks_;        // that are held
  std::vector<Told> to_tell_;        // to other ranks
  std::vector<glm::ivec3> changed_;  // whose neighbours have not been told; any cell of a block without sides
};

}  // namespace

size_t bound_white_pockets(VoxelGrid& voxels, const RanksOfVolume* ranks) {
  const Leaving leaving(voxels, ranks);
  for (size_t i = 0; i < voxels.side_count(); ++i) {
    shared::Side& side = voxels.mutable_sides()[i];
    for (int band = 0; band < 3; ++band) {
      if ((leaving.bands(shared::cell_coord(voxels.grid(), side.cell)) >> band & 1u) == 0)
        side.albedo[band] = std::min(side.albedo[band], MAX_POCKET_ALBEDO);
    }
  }
  std::array<std::int64_t, 1> count{std::int64_t(leaving.cells_without_some())};
  if (ranks != nullptr) ranks->ranks.add(count);
  return size_t(count[0]);
}

bool may_have_white_pockets(float largest_albedo) { return largest_albedo >= WHITE_ALBEDO; }

}  // namespace volgi
