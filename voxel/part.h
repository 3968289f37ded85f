#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace volgi {

/// A box of blocks of 8^3 cells, `last` not among them.
struct BlockBox {
  glm::ivec3 first{0}, last{0};

  glm::ivec3 size() const { return last - first; }
  size_t count() const { return size_t(last.x - first.x) * size_t(last.y - first.y) * size_t(last.z - first.z); }
  bool empty() const { return first.x >= last.x || first.y >= last.y || first.z >= last.z; }
  bool contains(glm::ivec3 b) const {
    return glm::all(glm::greaterThanEqual(b, first)) && glm::all(glm::lessThan(b, last));
  }
  /// Offset of a block in the box, x fastest.
  size_t index(glm::ivec3 b) const {
    const glm::ivec3 n = size(), at = b - first;
    return size_t(at.x) + size_t(n.x) * (size_t(at.y) + size_t(n.y) * size_t(at.z));
  }
  glm::ivec3 block(size_t index) const {
    const glm::ivec3 n = size();
    const size_t row = index / size_t(n.x);
    return first + glm::ivec3(int(index % size_t(n.x)), int(row % size_t(n.y)), int(row / size_t(n.y)));
  }
  friend bool operator==(const BlockBox&, const BlockBox&) = default;
};

/// How a grid's blocks are dealt out to ranks: columns along x, y and z divided (Koch, Baker and Alcouffe 1992), so
/// that a sweep goes through all of a rank's cells before it leaves it by x. Any number of ranks and any grid: parts
/// along an axis differ by one block at most, unless they are evened out, and where there are fewer blocks than parts
/// some are empty.
class Decomposition {
 public:
  /// Of so many ranks, as many along y and z as leave the smallest faces between parts.
  Decomposition(glm::ivec3 blocks, int ranks);
  Decomposition(glm::ivec3 blocks, glm::ivec2 ranks_along_yz);

  /// As many parts along y and z, cut where the heaviest weighs least, or nearly: of either axis in turn, the best cuts
  /// for those of the other.
  /// @param weights  of columns of blocks, y fastest.
  Decomposition evened_out(const std::vector<std::int64_t>& weights) const;

  /// The same parts of a grid of these blocks, about twice as many: cut at twice the places.
  Decomposition doubled(glm::ivec3 blocks) const;

  glm::ivec3 blocks() const { return blocks_; }
  int count() const { return along_.x * along_.y; }
  glm::ivec2 along_yz() const { return along_; }
  /// Of a rank: its place along y and z.
  glm::ivec2 place(int rank) const { return {rank % along_.x, rank / along_.x}; }
  BlockBox part(int rank) const;
  /// The rank that has the block.
  int owner(glm::ivec3 block) const;
  /// The rank beside one along y (axis 1) or z (axis 2); -1 at the rim.
  int beside(int rank, int axis, int step) const;
  /// Of the part that has most along each axis.
  glm::ivec2 widest() const;

 private:
  using Cuts = std::vector<int>;  // of an axis: where parts begin, and the end
  glm::ivec3 blocks_;
  glm::ivec2 along_{1};
  std::array<Cuts, 2> cuts_;  // y, z
};

}  // namespace volgi
