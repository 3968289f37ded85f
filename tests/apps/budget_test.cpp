#include "apps/bench/budget.h"

#include <gtest/gtest.h>

namespace volgi::app {
namespace {

TEST(Budget, LeavesOutByNameWhatWouldTakeTooLong) {
  nlohmann::json skipped = nlohmann::json::array();
  Budget budget(1000.0, skipped);
  budget.begin_part("volume", 0.5);
  EXPECT_TRUE(budget.allows("room", "at 32 cells", 1.0)) << "nothing is known yet";
  budget.took("room", 30.0, 1.0);
  EXPECT_TRUE(budget.allows("room", "at 64 cells", 8.0)) << "2 * 8 * 30 s of 500 s";
  EXPECT_TRUE(skipped.empty());
  EXPECT_FALSE(budget.allows("room", "at 128 cells", 64.0));
  ASSERT_EQ(skipped.size(), 1u);
  EXPECT_EQ(skipped[0]["part"], "volume");
  EXPECT_EQ(skipped[0]["what"], "room at 128 cells");
  EXPECT_DOUBLE_EQ(skipped[0]["estimate_s"], 2.0 * 64.0 * 30.0);
  EXPECT_NEAR(skipped[0]["left_s"].get<double>(), 500.0, 60.0);
}

TEST(Budget, EstimatesByTheSceneOrElseByTheSlowest) {
  nlohmann::json skipped = nlohmann::json::array();
  Budget budget(1000.0, skipped);
  budget.begin_part("passes", 1.0);
  budget.took("cornell", 1.0, 1.0);
  budget.took("atrium", 20.0, 1.0);
  budget.took("atrium", 10.0, 1.0);
  EXPECT_TRUE(budget.allows("cornell", "large", 100.0));
  EXPECT_FALSE(budget.allows("atrium", "large", 100.0)) << "by its slowest";
  EXPECT_FALSE(budget.allows("room", "large", 100.0)) << "as slow as the slowest";
  budget.begin_part("another", 1.0);
  EXPECT_TRUE(budget.allows("atrium", "large", 100.0)) << "works of two parts have no common measure";
}

TEST(Budget, MeasuresOnceWhereTimeIsShort) {
  nlohmann::json skipped = nlohmann::json::array();
  Budget budget(1000.0, skipped);
  budget.begin_part("passes", 0.5);
  EXPECT_EQ(budget.frames(10.0, 5), 5);
  EXPECT_EQ(budget.frames(100.0, 5), 1);
}

}  // namespace
}  // namespace volgi::app
