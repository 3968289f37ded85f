#include "voxel/part.h"

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <limits>

namespace volgi {

namespace {

int first_of(int blocks, int parts, int part) { return int(std::int64_t(blocks) * part / parts); }

/// Blocks' faces between parts, of all of them, and the emptiest part's loss.
std::int64_t cost(glm::ivec3 blocks, glm::ivec2 along) {
  const auto widest = [](int n, int parts) { return (n + parts - 1) / parts; };
  const std::int64_t largest = std::int64_t(widest(blocks.y, along.x)) * widest(blocks.z, along.y);
  const std::int64_t faces = std::int64_t(along.x - 1) * blocks.z + std::int64_t(along.y - 1) * blocks.y;
  return 4 * largest * along.x * along.y + faces;  // what the largest part has, all wait for
}

std::vector<int> even_cuts(int blocks, int parts) {
  std::vector<int> cuts;
  for (int part = 0; part <= parts; ++part) cuts.push_back(first_of(blocks, parts, part));
  return cuts;
}

int part_of(const std::vector<int>& cuts, int block) {
  return int(std::upper_bound(cuts.begin(), cuts.end() - 1, block) - cuts.begin()) - 1;
}

/// Cuts along one axis for which the heaviest part weighs least. @param row  (place along it, part of the other axis).
template <class Row>
std::vector<int> best_cuts(int blocks, int parts, int others, const Row& row) {
  std::vector<std::vector<std::int64_t>> before(size_t(others), std::vector<std::int64_t>(size_t(blocks) + 1, 0));
  for (int o = 0; o < others; ++o) {
    for (int i = 0; i < blocks; ++i) before[size_t(o)][size_t(i) + 1] = before[size_t(o)][size_t(i)] + row(i, o);
  }
  const auto heaviest = [&](int first, int last) {
    std::int64_t most = 0;
    for (const auto& b : before) most = std::max(most, b[size_t(last)] - b[size_t(first)]);
    return most;
  };
  // Of the first `end` places in so many parts: the least that the heaviest weighs, and where the last one begins.
  std::vector<std::vector<int>> begins(size_t(parts) + 1, std::vector<int>(size_t(blocks) + 1, 0));
  std::vector<std::int64_t> least(size_t(blocks) + 1, std::numeric_limits<std::int64_t>::max());
  least[0] = 0;
  for (int part = 1; part <= parts; ++part) {
    std::vector<std::int64_t> next(least.size(), std::numeric_limits<std::int64_t>::max());
    for (int end = 0; end <= blocks; ++end) {
      for (int begin = end; begin >= 0; --begin) {
        const std::int64_t last = heaviest(begin, end), weight = std::max(least[size_t(begin)], last);
        if (weight < next[size_t(end)]) next[size_t(end)] = weight, begins[size_t(part)][size_t(end)] = begin;
        if (last > next[size_t(end)]) break;
      }
    }
    least = next;
  }
  std::vector<int> cuts(size_t(parts) + 1, blocks);
  for (int part = parts; part > 0; --part) cuts[size_t(part) - 1] = begins[size_t(part)][size_t(cuts[size_t(part)])];
  return cuts;
}

}  // namespace

Decomposition::Decomposition(glm::ivec3 blocks, int ranks) : blocks_(blocks), along_(1, ranks) {
  for (int y = 1; y <= ranks; ++y) {
    if (ranks % y != 0) continue;
    const glm::ivec2 along(y, ranks / y);
    if (cost(blocks, along) < cost(blocks, along_)) along_ = along;
  }
  cuts_ = {even_cuts(blocks.y, along_.x), even_cuts(blocks.z, along_.y)};
}

Decomposition::Decomposition(glm::ivec3 blocks, glm::ivec2 ranks_along_yz)
    : blocks_(blocks),
      along_(ranks_along_yz),
      cuts_{even_cuts(blocks.y, ranks_along_yz.x), even_cuts(blocks.z, ranks_along_yz.y)} {}

Decomposition Decomposition::evened_out(const std::vector<std::int64_t>& weights) const {
  assert(weights.size() == size_t(blocks_.y) * size_t(blocks_.z));
  constexpr int kTurns = 8;  // they soon stay
  Decomposition d = *this;
  const auto weight = [&](int y, int z) { return weights[size_t(y) + size_t(blocks_.y) * size_t(z)]; };
  for (int turn = 0; turn < kTurns; ++turn) {
    const auto across_z = [&](int y, int part) {
      std::int64_t sum = 0;
      for (int z = d.cuts_[1][size_t(part)]; z < d.cuts_[1][size_t(part) + 1]; ++z) sum += weight(y, z);
      return sum;
    };
    d.cuts_[0] = best_cuts(blocks_.y, along_.x, along_.y, across_z);
    const auto across_y = [&](int z, int part) {
      std::int64_t sum = 0;
      for (int y = d.cuts_[0][size_t(part)]; y < d.cuts_[0][size_t(part) + 1]; ++y) sum += weight(y, z);
      return sum;
    };
    d.cuts_[1] = best_cuts(blocks_.z, along_.y, along_.x, across_y);
  }
  return d;
}

Decomposition Decomposition::doubled(glm::ivec3 blocks) const {
  Decomposition d(blocks, along_);
  for (int axis = 0; axis < 2; ++axis) {
    Cuts& cuts = d.cuts_[size_t(axis)];
    for (size_t i = 0; i < cuts.size(); ++i) cuts[i] = std::min(2 * cuts_[size_t(axis)][i], blocks[axis + 1]);
  }
  return d;
}

glm::ivec2 Decomposition::widest() const {
  glm::ivec2 most(0);
  for (int axis = 0; axis < 2; ++axis) {
    const Cuts& cuts = cuts_[size_t(axis)];
    for (size_t i = 1; i < cuts.size(); ++i) most[axis] = std::max(most[axis], cuts[i] - cuts[i - 1]);
  }
  return most;
}

BlockBox Decomposition::part(int rank) const {
  const glm::ivec2 at = place(rank);
  return {{0, cuts_[0][size_t(at.x)], cuts_[1][size_t(at.y)]},
          {blocks_.x, cuts_[0][size_t(at.x) + 1], cuts_[1][size_t(at.y) + 1]}};
}

int Decomposition::owner(glm::ivec3 block) const {
  assert(block.y >= 0 && block.y < blocks_.y && block.z >= 0 && block.z < blocks_.z);
  return part_of(cuts_[0], block.y) + along_.x * part_of(cuts_[1], block.z);
}

int Decomposition::beside(int rank, int axis, int step) const {
  glm::ivec2 at = place(rank);
  at[axis - 1] += step;
  if (at.x < 0 || at.y < 0 || at.x >= along_.x || at.y >= along_.y) return -1;
  return at.x + along_.x * at.y;
}

}  // namespace volgi
