#include "voxel/part.h"

#include <gtest/gtest.h>

namespace volgi::test {
namespace {

// Every block has one owner, parts differ by one block an axis, and columns along x are whole.
TEST(Decomposition, DealsOutAllBlocks) {
  for (const glm::ivec3 blocks : {glm::ivec3(8), {8, 3, 5}, {1, 1, 1}, {2, 7, 1}, {16, 16, 4}}) {
    for (const int ranks : {1, 2, 3, 4, 5, 6, 7, 8, 13, 64}) {
      const Decomposition d(blocks, ranks);
      ASSERT_EQ(d.count(), ranks);
      size_t dealt = 0;
      glm::ivec3 least(1000), most(0);
      for (int rank = 0; rank < ranks; ++rank) {
        const BlockBox part = d.part(rank);
        dealt += part.count();
        least = glm::min(least, part.size());
        most = glm::max(most, part.size());
        for (size_t i = 0; i < part.count(); ++i) ASSERT_EQ(d.owner(part.block(i)), rank);
      }
      EXPECT_EQ(dealt, size_t(blocks.x * blocks.y * blocks.z));
      EXPECT_EQ(least.x, blocks.x);
      EXPECT_LE(most.y - least.y, 1);
      EXPECT_LE(most.z - least.z, 1);
    }
  }
}

// A cube goes to ranks in columns as square as can be: the least light crosses between them.
TEST(Decomposition, LeastFacesBetweenParts) {
  EXPECT_EQ(Decomposition(glm::ivec3(16), 4).along_yz(), glm::ivec2(2, 2));
  EXPECT_EQ(Decomposition(glm::ivec3(16), 16).along_yz(), glm::ivec2(4, 4));
  EXPECT_EQ(Decomposition({16, 16, 2}, 8).along_yz(), glm::ivec2(8, 1));
}

// A heavy corner: the best cuts of either axis for those of the other, no worse than even ones, and all is dealt out.
TEST(Decomposition, EvenedOutByWeight) {
  const glm::ivec3 blocks(4, 12, 10);
  std::vector<std::int64_t> weights(120, 10);
  for (int z = 0; z < 10; ++z) {
    for (int y = 0; y < 12; ++y) weights[size_t(y + 12 * z)] += (y < 3 ? 60 : 0) + (z < 3 ? 60 : 0);
  }
  const auto heaviest = [&](const Decomposition& d) {
    std::int64_t most = 0, all = 0;
    size_t dealt = 0;
    for (int rank = 0; rank < d.count(); ++rank) {
      const BlockBox part = d.part(rank);
      std::int64_t sum = 0;
      for (int z = part.first.z; z < part.last.z; ++z) {
        for (int y = part.first.y; y < part.last.y; ++y) sum += weights[size_t(y + 12 * z)];
      }
      for (size_t i = 0; i < part.count(); ++i) EXPECT_EQ(d.owner(part.block(i)), rank);
      dealt += part.count();
      all += sum;
      most = std::max(most, sum);
    }
    EXPECT_EQ(dealt, size_t(blocks.x * blocks.y * blocks.z));
    return double(most) * d.count() / double(all);
  };
  for (const int ranks : {2, 4, 6, 9}) {
    const Decomposition even(blocks, ranks), out = even.evened_out(weights);
    EXPECT_EQ(out.along_yz(), even.along_yz());
    EXPECT_LT(heaviest(out), heaviest(even)) << ranks;
  }
  // Of two by two the best of all cuts: the heaviest of four parts, by sums over their corners.
  const auto sum = [&](int y0, int y1, int z0, int z1) {
    std::int64_t s = 0;
    for (int z = z0; z < z1; ++z) {
      for (int y = y0; y < y1; ++y) s += weights[size_t(y + 12 * z)];
    }
    return s;
  };
  std::int64_t best = sum(0, 12, 0, 10);
  for (int y = 0; y <= 12; ++y) {
    for (int z = 0; z <= 10; ++z)
      best = std::min(best, std::max({sum(0, y, 0, z), sum(y, 12, 0, z), sum(0, y, z, 10), sum(y, 12, z, 10)}));
  }
  EXPECT_EQ(heaviest(Decomposition(blocks, 4).evened_out(weights)), double(best) * 4 / double(sum(0, 12, 0, 10)));
  // Uniform weights: even parts are the best there are.
  EXPECT_EQ(heaviest(Decomposition(blocks, 4).evened_out(std::vector<std::int64_t>(120, 7))),
            heaviest(Decomposition(blocks, 4)));
}

// A block of cells of twice the edge and the fine blocks in it are one rank's.
TEST(Decomposition, DoubledHoldsTheSame) {
  for (const glm::ivec3 fine : {glm::ivec3(16), {9, 7, 5}, {3, 1, 2}}) {
    for (const int ranks : {2, 3, 8}) {
      const Decomposition coarse((fine + 1) / 2, ranks), d = coarse.doubled(fine);
      size_t dealt = 0;
      for (int rank = 0; rank < ranks; ++rank) {
        const BlockBox part = d.part(rank);
        dealt += part.count();
        for (size_t i = 0; i < part.count(); ++i) ASSERT_EQ(coarse.owner(part.block(i) / 2), rank);
      }
      EXPECT_EQ(dealt, size_t(fine.x * fine.y * fine.z));
    }
  }
}

TEST(Decomposition, NeighboursAreMutual) {
  const Decomposition d({8, 8, 12}, 6);
  for (int rank = 0; rank < 6; ++rank) {
    for (const int axis : {1, 2}) {
      const int next = d.beside(rank, axis, 1);
      const bool at_rim = d.part(rank).last[axis] == d.blocks()[axis];
      ASSERT_EQ(next < 0, at_rim);
      if (next < 0) continue;
      EXPECT_EQ(d.beside(next, axis, -1), rank);
      EXPECT_EQ(d.part(next).first[axis], d.part(rank).last[axis]);
    }
  }
}

}  // namespace
}  // namespace volgi::test
