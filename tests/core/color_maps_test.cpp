// Colour maps that pictures and windows share.
#include "shaders/shared/color_maps.shared.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace volgi::test {
namespace {

TEST(ColorMaps, DifferencesAreSigned) {
  EXPECT_EQ(shared::difference_color(0.0f), glm::vec3(1.0f));
  EXPECT_EQ(shared::difference_color(1.0f), glm::vec3(1.0f, 0.0f, 0.0f));
  EXPECT_EQ(shared::difference_color(-5.0f), glm::vec3(0.0f, 0.0f, 1.0f));
  EXPECT_EQ(shared::difference_color(0.25f), glm::vec3(1.0f, 0.75f, 0.75f));
}

TEST(ColorMaps, NumbersInARowAreTold) {
  for (shared::uint i = 0; i < 64; ++i) {
    const glm::vec3 color = shared::hashed_color(i);
    EXPECT_GE(std::min({color.r, color.g, color.b}), 0.2f);
    EXPECT_LE(std::max({color.r, color.g, color.b}), 1.0f);
    for (shared::uint k = 1; k <= 3; ++k) {  // four in a row: 30 of 255 levels apart in some band
      const glm::vec3 apart = glm::abs(shared::hashed_color(i + k) - color);
      EXPECT_GT(std::max({apart.r, apart.g, apart.b}), 0.12f) << i << " and " << i + k;
    }
  }
}

}  // namespace
}  // namespace volgi::test
