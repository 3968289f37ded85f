#include "voxel/white_pockets.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "shaders/voxel/white_pockets.shared.h"

namespace volgi {

namespace {

/// Bands in which light leaves each cell in the end, spread from those where it does at once.
class Leaving {
 public:
  Leaving(const VoxelGrid& voxels, const RanksOfVolume* ranks)
      : voxels_(voxels),
        first_(kLeafCells * voxels.part().first),
        last_(glm::min(kLeafCells * voxels.part().last, voxels.grid().cells)),
        held_first_(kLeafCells * voxels.held().first),
        held_size_(kLeafCells * voxels.held().size()),
        bands_(512 * voxels.held().count(), 0) {
    for (size_t i = 0; i < voxels.side_count(); ++i) {
      const shared::Side& side = voxels.sides()[i];
      add(shared::cell_coord(voxels.grid(), side.cell), shared::bands_below_white(side.albedo));
    }
    for (int face = 0; face < 6; ++face) start_at_rim(face);
    do {
      while (!changed_.empty()) spread(pop());
    } while (ranks != nullptr && told_others(*ranks));
  }
  std::uint32_t bands(int cell) const { return bands_[index(shared::cell_coord(voxels_.grid(), cell))]; }
  size_t cells_without_some() const {
    size_t count = 0;
    for (glm::ivec3 c = first_; c.z < last_.z; ++c.z) {
      for (c.y = first_.y; c.y < last_.y; ++c.y) {
        for (c.x = first_.x; c.x < last_.x; ++c.x) count += bands_[index(c)] != ALL_BANDS;
      }
    }
    return count;
  }

 private:
  struct Told {
    glm::ivec3 cell;
    std::uint32_t bands;
  };

  size_t index(glm::ivec3 cell) const {
    const glm::ivec3 c = cell - held_first_;
    return size_t(c.x) + size_t(held_size_.x) * (size_t(c.y) + size_t(held_size_.y) * size_t(c.z));
  }
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
  void add(glm::ivec3 cell, std::uint32_t bands) {
    std::uint8_t& own = bands_[index(cell)];
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
    const glm::uvec2 sides = voxels_.cell_sides(cell);
    const std::uint32_t own = bands_[index(cell)];
    for (int face = 0; face < 6; ++face) {
      const glm::ivec3 next = cell + shared::face_step(face);
      if (!shared::cell_inside(voxels_.grid(), next) || shared::is_opaque(sides, face)) continue;
      if (is_own(next)) {
        add(next, own);
      } else if ((own & ~std::uint32_t(bands_[index(next)])) != 0) {
        bands_[index(next)] = std::uint8_t(bands_[index(next)] | own);  // told once
        to_tell_.push_back({next, own});
      }
    }
  }

  const VoxelGrid& voxels_;
  glm::ivec3 first_, last_;  // cells of the part
  glm::ivec3 held_first_, held_size_;
  std::vector<std::uint8_t> bands_;  // of every cell that is held
  std::vector<Told> to_tell_;        // to other ranks
  std::vector<glm::ivec3> changed_;  // whose neighbours have not been told
};

}  // namespace

size_t bound_white_pockets(VoxelGrid& voxels, const RanksOfVolume* ranks) {
  const Leaving leaving(voxels, ranks);
  for (size_t i = 0; i < voxels.side_count(); ++i) {
    shared::Side& side = voxels.mutable_sides()[i];
    for (int band = 0; band < 3; ++band) {
      if ((leaving.bands(side.cell) >> band & 1u) == 0)
        side.albedo[band] = std::min(side.albedo[band], MAX_POCKET_ALBEDO);
    }
  }
  std::array<std::int64_t, 1> count{std::int64_t(leaving.cells_without_some())};
  if (ranks != nullptr) ranks->ranks.add(count);
  return size_t(count[0]);
}

bool may_have_white_pockets(float largest_albedo) { return largest_albedo >= WHITE_ALBEDO; }

}  // namespace volgi
