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
