#include "propagation/sweep/sweep_model.h"

#include <gtest/gtest.h>

#include <cmath>

namespace volgi::test {
namespace {

SweepModel free_messages(glm::ivec2 ranks, int chunks) { return {ranks, chunks, 1.0, 0.0, 0.0, 0.0, 1e30}; }

// One rank does its tasks; two and four have all they need when they are through with their own corners.
TEST(SweepModel, SmallNumbersOfRanksNeverWait) {
  for (const glm::ivec2 ranks : {glm::ivec2(1, 1), {1, 2}, {2, 1}, {2, 2}}) {
    for (const int chunks : {1, 4}) {
      const SweepPrediction p = predict(free_messages(ranks, chunks));
      EXPECT_EQ(p.sweep_s, 8.0 * chunks);
      EXPECT_EQ(p.efficiency, 1.0);
      EXPECT_EQ(p.least_stages, 8 * chunks);
    }
  }
}

// The priority by stages behind reaches the least number of stages that Adams et al. give, or nearly: within one in
// twenty for these.
TEST(SweepModel, NearlyTheLeastStages) {
  for (const glm::ivec2 ranks : {glm::ivec2(4, 2), {4, 4}, {8, 8}, {3, 3}, {16, 4}}) {
    for (const int chunks : {4, 8, 16}) {
      const SweepPrediction p = predict(free_messages(ranks, chunks));
      EXPECT_GE(p.sweep_s, double(p.least_stages) - 1e-9) << ranks.x << "x" << ranks.y << ", " << chunks;
      EXPECT_LE(p.sweep_s, 1.05 * double(p.least_stages)) << ranks.x << "x" << ranks.y << ", " << chunks;
    }
  }
}

// Room for fewer octants costs little where ranks are few: two of them lose nothing with four, four a stage in sixty.
TEST(SweepModel, FewerOctantsAtOnce) {
  SweepModel m = free_messages({1, 2}, 8);
  m.octants_at_once = 4;
  EXPECT_EQ(predict(m).sweep_s, 64.0);
  m.along_yz = {2, 2};
  EXPECT_EQ(predict(m).sweep_s, 65.0);
  m.octants_at_once = 2;
  EXPECT_LE(predict(m).sweep_s, 67.0);
  double before = 0.0;
  for (const int octants : {8, 4, 2, 1}) {
    m = free_messages({8, 8}, 16);
    m.octants_at_once = octants;
    EXPECT_GT(predict(m).sweep_s, before);
    before = predict(m).sweep_s;
  }
}

// Two ranks, one chunk: four tasks each, then those that came over. With messages slower than that, all wait for one.
TEST(SweepModel, MessagesCost) {
  SweepModel m = free_messages({1, 2}, 1);
  m.z_bytes = 10.0;
  m.bytes_per_s = 100.0;  // 0.1 a message, at either end
  m.latency_s = 0.5;
  EXPECT_NEAR(predict(m).sweep_s, 8.0 * 1.1, 1e-9);
  m.latency_s = 6.0;
  EXPECT_NEAR(predict(m).sweep_s, 1.1 + 6.0 + 3.0 * 1.1 + 1.1, 1.1);
}

}  // namespace
}  // namespace volgi::test
