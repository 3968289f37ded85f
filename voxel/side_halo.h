#pragma once
#include <vector>

#include "core/ranks.h"
#include "voxel/voxel_grid.h"

namespace volgi {

/// Which ranks hold one volume, and how its blocks are dealt out to them.
struct RanksOfVolume {
  const Ranks& ranks;
  Decomposition decomposition;
  bool lean = false;  // keeps as little at once as can be, also where ranks then wait for each other longer

  BlockBox part() const { return decomposition.part(ranks.rank()); }
};

/// Sides that several ranks know: each is one rank's own, and others, whose part is near, have it behind their own
/// (VoxelGrid). All ranks make one together and call its functions together.
class SideHalo {
 public:
  /// @throws Error(bad_input) where ranks do not agree about the sides they share, which would be a mistake of ours.
  SideHalo(const RanksOfVolume& ranks, const VoxelGrid& voxels);

  /// Values of own sides, to all that know them. @param values  by sides() of the voxels.
  template <class T>
  void fetch(std::vector<T>& values) const {
    const auto from = trade(values, own_, foreign_);
    for (size_t rank = 0; rank < from.size(); ++rank) {
      for (size_t i = 0; i < foreign_[rank].size(); ++i) values[foreign_[rank][i]] = from[rank][i];
    }
  }
  /// The other way: what each has for the sides of others is added to theirs.
  template <class T>
  void add_up(std::vector<T>& values) const {
    const auto from = trade(values, foreign_, own_);
    for (size_t rank = 0; rank < from.size(); ++rank) {
      for (size_t i = 0; i < own_[rank].size(); ++i) values[own_[rank][i]] += from[rank][i];
    }
  }

 private:
  using Lists = std::vector<std::vector<std::uint32_t>>;  // of sides, by rank
  template <class T>
  std::vector<std::vector<T>> trade(const std::vector<T>& values, const Lists& sent, const Lists& awaited) const {
    std::vector<std::vector<T>> to(sent.size());
    for (size_t rank = 0; rank < sent.size(); ++rank) {
      for (const std::uint32_t side : sent[rank]) to[rank].push_back(values[side]);
    }
    auto from = exchange_values(ranks_, to);
    for (size_t rank = 0; rank < from.size(); ++rank) check(from[rank].size() == awaited[rank].size());
    return from;
  }
  static void check(bool agree);

  const Ranks& ranks_;
  Lists own_, foreign_;  // own: that another one knows; foreign: known here
};

}  // namespace volgi
