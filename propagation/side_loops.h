#pragma once
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <glm/glm.hpp>
#include <vector>

#include "core/exact_sum.h"
#include "core/ranks.h"
#include "voxel/volume_sides.h"

namespace volgi {

/// Loops over sides on all threads. Blocks are the same for any number of threads.
constexpr size_t kSideBlock = 2048;

template <class Body>
void for_each_side(size_t count, const Body& body) {
  oneapi::tbb::parallel_for(size_t(0), (count + kSideBlock - 1) / kSideBlock, [&](size_t block) {
    const size_t last = std::min(count, (block + 1) * kSideBlock);
    for (size_t i = block * kSideBlock; i < last; ++i) body(i);
  });
}

/// Sums over all of a volume's sides that are the same whatever threads and ranks they are dealt out to: the terms of a
/// block of 8^3 cells, which is one rank's, are added up in order, and what blocks have exactly (core/exact_sum.h).
class SideSums {
 public:
  /// @param ranks  that have the other sides; null: there are none.
  void set(const VolumeSides& sides, const Ranks* ranks) {
    ranks_ = ranks;
    count_ = sides.count();
    starts_.clear();
    for (size_t level = 0; level < sides.levels(); ++level) {
      const VoxelGrid& voxels = sides.level(level);
      glm::ivec3 last(-1);
      for (size_t i = 0; i < voxels.side_count(); ++i) {
        const glm::ivec3 block = shared::cell_coord(voxels.grid(), voxels.sides()[i].cell) / kLeafCells;
        if (block != last) starts_.push_back(sides.first(level) + i);
        last = block;
      }
    }
  }

  /// @param term  (number of an own side) -> glm::dvec3. All ranks.
  template <class Term>
  glm::dvec3 operator()(const Term& term) const {
    constexpr size_t kStarts = 64;
    std::vector<std::array<ExactSum, 3>> partial((starts_.size() + kStarts - 1) / kStarts);
    oneapi::tbb::parallel_for(size_t(0), partial.size(), [&](size_t p) {
      const size_t end = std::min(starts_.size(), (p + 1) * kStarts);
      for (size_t s = p * kStarts; s < end; ++s) {
        glm::dvec3 sum(0.0);
        const size_t last = s + 1 < starts_.size() ? starts_[s + 1] : count_;
        for (size_t i = starts_[s]; i < last; ++i) sum += term(i);
        for (size_t band = 0; band < 3; ++band) partial[p][band].add(sum[int(band)]);
      }
    });
    std::array<ExactSum, 3> all;
    for (const auto& p : partial) {
      for (size_t band = 0; band < 3; ++band) all[band].add(p[band]);
    }
    return over_ranks(all, ranks_);
  }

  /// All ranks: what theirs add up to.
  static glm::dvec3 over_ranks(std::array<ExactSum, 3>& sums, const Ranks* ranks) {
    glm::dvec3 value;
    for (size_t band = 0; band < 3; ++band) {
      if (ranks != nullptr) ranks->add(sums[band].parts());
      value[int(band)] = sums[band].value();
    }
    return value;
  }

 private:
  const Ranks* ranks_ = nullptr;
  size_t count_ = 0;
  std::vector<size_t> starts_;  // of sides of one block
};

}  // namespace volgi
