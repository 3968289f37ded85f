#include "propagation/bounce_rules.h"

#include <gtest/gtest.h>

#include <cmath>

namespace volgi {
namespace {

BounceRules with_albedo(float albedo) {
  BounceRules rules;
  rules.largest_albedo = albedo;
  return rules;
}

TEST(BounceRules, AbsorptionIsBoundedBelow) {
  EXPECT_NEAR(with_albedo(0.7f).absorption(), 0.3f, 1e-6f);
  EXPECT_EQ(with_albedo(1.0f).absorption(), BounceRules::kMinAbsorption);
}

TEST(BounceRules, PulseEndsWhenTheSlowestBandHas) {
  const BounceRules rules = with_albedo(0.5f);
  const float limit = BounceRules::kTolerance * 0.5f;
  EXPECT_TRUE(rules.pulse_ended(glm::vec3(0.9f * limit), glm::vec3(1.0f)));
  EXPECT_FALSE(rules.pulse_ended(glm::vec3(0.0f, 1.1f * limit, 0.0f), glm::vec3(1.0f)));
  EXPECT_TRUE(rules.pulse_ended(glm::vec3(0.0f), glm::vec3(0.0f)));
  EXPECT_TRUE(rules.pulse_ended(glm::vec3(9e5f * limit), glm::vec3(1e6f)));  // relative to what was sent
}

// What all later orders can add, the geometric series of the largest albedo, is under the tolerance.
TEST(BounceRules, OrdersEndWithinTheTolerance) {
  for (float albedo : {0.3f, 0.7f, 0.95f, 0.99f}) {
    const BounceRules rules = with_albedo(albedo);
    double sent = 1.0, total = 0.0;
    int orders = 0;
    while (!rules.orders_ended(glm::vec3(float(sent)), glm::vec3(float(total))) && orders < 10000) {
      total += sent;
      sent *= double(albedo);
      ++orders;
    }
    EXPECT_LE(1.0 / (1.0 - double(albedo)) - total, 1.01 * double(BounceRules::kTolerance) * total);
    EXPECT_GT(orders, 1);
    EXPECT_LE(orders, rules.expected_orders() + 2);
  }
}

TEST(BounceRules, ReflectionsInFlightTogether) {
  BounceRules rules;
  EXPECT_FALSE(rules.together());
  rules.iterations = 32;
  EXPECT_TRUE(rules.together());
  rules.bounces = 2;
  EXPECT_FALSE(rules.together());
  EXPECT_EQ(rules.expected_orders(), 2);
}

TEST(BounceRules, ChoosesTheSolver) {
  BounceRules rules;
  EXPECT_TRUE(rules.conjugate_gradients(true));
  EXPECT_FALSE(rules.conjugate_gradients(false));
  rules.iterations = 3;  // orders, as asked for
  EXPECT_FALSE(rules.conjugate_gradients(true));
  rules.solver = BounceRules::Solver::conjugate_gradients;
  EXPECT_TRUE(rules.conjugate_gradients(true));
  rules = {};
  rules.bounces = 2;
  EXPECT_FALSE(rules.conjugate_gradients(true));
  rules = {};
  rules.passes_per_run = 2;
  EXPECT_FALSE(rules.conjugate_gradients(true));
}

TEST(BounceRules, ContinuesWhereAllBouncesAreAskedFor) {
  BounceRules rules;
  EXPECT_FALSE(rules.continues());
  rules.warm_start = true;
  EXPECT_TRUE(rules.continues());
  rules.bounces = 2;
  EXPECT_FALSE(rules.continues());
  rules = {};
  rules.passes_per_run = 1;
  EXPECT_TRUE(rules.continues());
  EXPECT_EQ(rules.arrival_cycle(false), 2);
  rules.passes_per_run = 5;
  EXPECT_EQ(rules.arrival_cycle(false), 5);
  EXPECT_EQ(rules.arrival_cycle(true), 2);
}

}  // namespace
}  // namespace volgi
