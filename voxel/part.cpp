#include "voxel/part.h"

#include <cassert>
#include <cstdint>

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

}  // namespace

Decomposition::Decomposition(glm::ivec3 blocks, int ranks) : blocks_(blocks), along_(1, ranks) {
  for (int y = 1; y <= ranks; ++y) {
    if (ranks % y != 0) continue;
    const glm::ivec2 along(y, ranks / y);
    if (cost(blocks, along) < cost(blocks, along_)) along_ = along;
  }
}

Decomposition::Decomposition(glm::ivec3 blocks, glm::ivec2 ranks_along_yz) : blocks_(blocks), along_(ranks_along_yz) {}

BlockBox Decomposition::part(int rank) const {
  const glm::ivec2 at = place(rank);
  return {{0, first_of(blocks_.y, along_.x, at.x), first_of(blocks_.z, along_.y, at.y)},
          {blocks_.x, first_of(blocks_.y, along_.x, at.x + 1), first_of(blocks_.z, along_.y, at.y + 1)}};
}

int Decomposition::owner(glm::ivec3 block) const {
  const auto part_of = [](int n, int parts, int b) {
    int part = int((std::int64_t(b) * parts + parts - 1) / n);
    while (part > 0 && first_of(n, parts, part) > b) --part;
    while (part + 1 < parts && first_of(n, parts, part + 1) <= b) ++part;
    return part;
  };
  assert(block.y >= 0 && block.y < blocks_.y && block.z >= 0 && block.z < blocks_.z);
  return part_of(blocks_.y, along_.x, block.y) + along_.x * part_of(blocks_.z, along_.y, block.z);
}

int Decomposition::beside(int rank, int axis, int step) const {
  glm::ivec2 at = place(rank);
  at[axis - 1] += step;
  if (at.x < 0 || at.y < 0 || at.x >= along_.x || at.y >= along_.y) return -1;
  return at.x + along_.x * at.y;
}

}  // namespace volgi
