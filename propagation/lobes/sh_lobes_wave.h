#pragma once
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <xmmintrin.h>

#include <algorithm>
#include <vector>

#include "core/ranks.h"
#include "propagation/lobes/sh_lobes.h"
#include "propagation/lobes/sh_lobes_kernels.h"
#include "voxel/side_halo.h"

namespace volgi {

/// Light in flight: two states of lobes, and which leaves take part in a pass. Leaves join as light arrives in them and
/// drop out when they are dark; what passes do is up to the scheme. A rank's wave is of the leaves of its part, and has
/// the outermost cells of those beside them from their ranks before every pass.
class LobeWave {
  struct LitRows {
    std::uint64_t any = 0, low = 0, high = 0;  // LeafLight
  };

 public:
  /// @param ranks  that the numbers are of a part of; null: there is one. All then do everything together.
  LobeWave(const LeafNumbers& numbers, int coefficients, const RanksOfVolume* ranks = nullptr);

  /// Starts over. @param fill  (number of leaf, its lobes unset, LeafLight&).
  template <typename Fill>
  void start(std::vector<int> leaves, const Fill& fill);
  /// One pass. @param pass_leaf  (number of leaf, its next lobes unset, LeafLight&), reading now().
  template <typename PassLeaf>
  void step(const PassLeaf& pass_leaf);

  const LeafNumbers& numbers() const { return numbers_; }
  const LobeVolume& now() const { return now_; }
  glm::dvec3 in_flight() const { return in_flight_; }  // power per band [W], of all ranks
  /// The leaves beside one: of zeros where there are none.
  void find_beside(int number, const float* beside[6]) const;
  /// Rows of a leaf (LeafLight) that a pass may leave light in: those with light and those beside them.
  std::uint64_t rows_reached(int number) const;
  /// Those with light. (All, in dense waves.)
  std::uint64_t rows_lit(int number) const { return dense_ ? kAllRows : lit_[size_t(number)].any; }
  /// Within step(): of leaf `number` only these rows will be written; the others become dark.
  void write_only(int number, std::uint64_t rows);
  /// Whether what step() writes is better not kept in the cache.
  bool streams() const { return streams_; }
  /// All leaves take part, lit or not: what sparse storage is measured against.
  void set_dense(bool dense) { dense_ = dense; }
  bool dense() const { return dense_; }
  /// What bytes() will be where light is everywhere.
  static size_t bytes_for(const LeafNumbers& numbers, int coefficients) {
    const auto all = size_t(numbers.count());
    return 2 * LobeVolume::bytes_for(numbers, coefficients, all) + all * (sizeof(LeafLight) + sizeof(LitRows));
  }
  size_t bytes() const {
    return now_.bytes() + next_.bytes() + light_.capacity() * sizeof(LeafLight) + lit_.size() * sizeof(LitRows);
  }

 private:
  template <typename F>
  static void for_leaves(size_t count, const F& f);
  std::vector<int> reached() const;
  void settle(LobeVolume& lobes);
  void find_partners();
  void fetch_beside();
  /// What a leaf shows a leaf of another rank: its number there, and of which of its faces.
  struct Shown {
    int number, face;
  };
  struct Partner {
    int rank;
    std::vector<Shown> own;  // leaves that it looks at
    Ranks::Bytes to, from;   // room for all
  };
  size_t shown_floats() const { return now_.leaf_floats() / kLobeLeafCells * 64; }
  size_t shown_bytes() const;

  LeafNumbers numbers_;
  LobeVolume now_, next_;
  std::vector<LeafLight> light_;  // of now_.leaves()
  std::vector<LitRows> lit_;      // by number of leaf, of now_
  glm::dvec3 in_flight_{0.0};
  bool dense_ = false;
  bool streams_ = false;
  const RanksOfVolume* ranks_ = nullptr;
  std::vector<Partner> partners_;
};

/// The rim of a pulse thins out by powers and would end in denormal numbers, many times slower: they count as zero.
class FlushDenormals {
 public:
  FlushDenormals() : before_(_mm_getcsr()) { _mm_setcsr(before_ | 0x8040u); }  // FTZ | DAZ
  ~FlushDenormals() { _mm_setcsr(before_); }
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;

 private:
  unsigned before_;
};

/// f(i) for i < count on all threads; what f writes does not depend on order.
template <typename F>
void LobeWave::for_leaves(size_t count, const F& f) {
  tbb::parallel_for(tbb::blocked_range<size_t>(0, count, 4), [&](const tbb::blocked_range<size_t>& range) {
    const FlushDenormals flush;
    for (size_t i = range.begin(); i != range.end(); ++i) f(i);
    _mm_sfence();  // streamed leaves are there for all threads
  });
}

template <typename Fill>
void LobeWave::start(std::vector<int> leaves, const Fill& fill) {
  now_.assign(std::move(leaves));
  for (const int n : now_.leaves()) now_.rows_written(n) = kAllRows;
  std::fill(lit_.begin(), lit_.end(), LitRows{});
  light_.resize(now_.leaves().size());
  for_leaves(light_.size(), [&](size_t i) { fill(now_.leaves()[i], now_.leaf(now_.leaves()[i]), light_[i]); });
  settle(now_);
  fetch_beside();
}

template <typename PassLeaf>
void LobeWave::step(const PassLeaf& pass_leaf) {
  next_.assign(reached());
  light_.resize(next_.leaves().size());
  streams_ = 2 * light_.size() * next_.leaf_floats() * sizeof(float) > LobeVolume::cache_bytes();
  for_leaves(light_.size(), [&](size_t i) { pass_leaf(next_.leaves()[i], next_.leaf(next_.leaves()[i]), light_[i]); });
  settle(next_);
  now_.swap(next_);
  fetch_beside();
}

}  // namespace volgi
