// Hilbert's curve, there and back: core/hilbert.h and shaders/shared/hilbert.shared.h.
#include <gtest/gtest.h>

#include <cstdint>

#include "core/hilbert.h"
#include "shaders/shared/hilbert.shared.h"

namespace volgi::test {
namespace {

TEST(Hilbert, ThereAndBack) {
  for (std::uint64_t k = 0; k < 4096; ++k) {
    const auto index = std::uint32_t(k * 2654435761u + 12345u);
    EXPECT_EQ(hilbert_index(shared::hilbert_point(index)), index);
  }
  for (const std::uint32_t index : {0u, 1u, 0x7fffffffu, 0xffffffffu}) {
    EXPECT_EQ(hilbert_index(shared::hilbert_point(index)), index);
  }
}

TEST(Hilbert, WhatFollowsIsBeside) {
  constexpr float kCell = 1.0f / 65536.0f;
  for (std::uint32_t k = 0; k < 4096; ++k) {
    const std::uint32_t index = k * 1048573u;
    const glm::vec2 step = glm::abs(shared::hilbert_point(index + 1) - shared::hilbert_point(index));
    EXPECT_EQ(step.x + step.y, kCell) << index;
  }
}

// A piece of one part in 4^n that begins at a multiple of its length is a square.
TEST(Hilbert, PiecesAreCompact) {
  for (std::uint32_t first = 0; first < 64; ++first) {
    glm::vec2 low(2.0f), high(-1.0f);
    for (std::uint32_t k = 0; k < 1024; ++k) {
      const glm::vec2 p = shared::hilbert_point((first << 26) + (k << 16));
      low = glm::min(low, p);
      high = glm::max(high, p);
    }
    EXPECT_LE(high.x - low.x, 0.125f);
    EXPECT_LE(high.y - low.y, 0.125f);
  }
}

}  // namespace
}  // namespace volgi::test
