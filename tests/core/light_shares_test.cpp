// How virtual lights are shared among sources.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numeric>

#include "core/light_shares.h"
#include "core/sky.h"
#include "tests/screen/virtual_light_scenes.h"

namespace volgi::test {
namespace {

TEST(LightShares, FollowPowerAndSumToTheCount) {
  EXPECT_EQ(share_out({1, 2, 1}, 1024), (std::vector<int>{256, 512, 256}));
  EXPECT_EQ(share_out({1, 1, 1}, 1024), (std::vector<int>{342, 341, 341}));
  EXPECT_EQ(share_out({0, 1e9, 1e-3}, 15), (std::vector<int>{0, 14, 1}));
  EXPECT_EQ(share_out({3, 0, 1, 2}, 2), (std::vector<int>{1, 0, 0, 1}));
  EXPECT_EQ(share_out({3, 1}, 1), (std::vector<int>{1, 0}));
  EXPECT_EQ(share_out({0, 0}, 7), (std::vector<int>{0, 0}));
  EXPECT_EQ(share_out({}, 7), (std::vector<int>{}));
  std::vector<double> power;
  for (int i = 0; i < 37; ++i) power.push_back(std::pow(1.37, i % 11) - 1.0);
  const double total = std::accumulate(power.begin(), power.end(), 0.0);
  const std::vector<int> share = share_out(power, 4000);
  EXPECT_EQ(std::accumulate(share.begin(), share.end(), 0), 4000);
  const int least = 4000 / (8 * 33);  // of 33 that send anything
  for (size_t i = 0; i < power.size(); ++i) {
    if (power[i] > 0.0 && 4000 * power[i] / total < least) {
      EXPECT_EQ(share[i], least);
    } else {
      EXPECT_NEAR(share[i], 4000 * power[i] / total, 0.01 * share[i] + 1.0);  // the weak ones' comes off
    }
  }
}

TEST(LightShares, WeakOnesHaveAnEighthOfAnEvenShare) {
  EXPECT_EQ(share_out({0, 1e9, 1e-3}, 100), (std::vector<int>{0, 94, 6}));
  EXPECT_EQ(share_out({1e5, 1, 1}, 240), (std::vector<int>{220, 10, 10}));
  EXPECT_EQ(share_out(std::vector<double>(64, 1.0), 64), std::vector<int>(64, 1));
}

TEST(LightShares, PowerOfSpotsIsTheIntegralOfTheirFalloff) {
  for (const glm::vec2 cone_deg : {glm::vec2(10, 40), glm::vec2(0, 90), glm::vec2(44.99, 45), glm::vec2(0, 1)}) {
    const Light light = spot_light({}, {0, -1, 0}, cone_deg.x, cone_deg.y, 2.0f);
    const double outer = 1.0 - std::cos(double(light.outer_cone_rad));
    const double ramp = std::max(0.001, outer - 1.0 + std::cos(double(light.inner_cone_rad)));
    double sum = 0.0;
    constexpr int steps = 100000;
    for (int i = 0; i < steps; ++i) sum += std::pow(std::min(1.0, (i + 0.5) / steps * outer / ramp), 2.0);
    const double brightness = 2.0 * (0.2126 + 0.8 * 0.7152 + 0.6 * 0.0722);
    const double expected = 2.0 * glm::pi<double>() * outer * sum / steps * brightness;
    EXPECT_NEAR(power_luminance(light, {}, {}) / expected, 1.0, 1e-5);
  }
  const Light sun = sun_light({0, -1, 0}, 1.0f);
  EXPECT_NEAR(power_luminance(sun, -kHalf, kHalf) / power_luminance(sun, -kHalf, 3.0f * kHalf), 0.25, 1e-5);
}

// A room with a lamp in it, on 200 m of ground, in sun and under a sky: the lamp keeps its half.
TEST(LightShares, WhatIsOutsideDoesNotTakeAll) {
  Scene scene;
  scene.bounds_min = {-100, 0, -100};
  scene.bounds_max = {100, 3, 100};
  scene.lights = {point_light({0, 2, 0}, 6.0f), sun_light({0, -1, 0}, 3.0f)};
  scene.sky = std::make_shared<Sky>(glm::vec3(1.0f));
  const LightShares both = share_by_power(scene, glm::dvec3(0.0), 1000);
  EXPECT_EQ(both.of_light[0], 500);
  EXPECT_EQ(both.of_light[1] + both.of_sky, 500);
  const LightShares without = share_by_power(scene, glm::dvec3(0.0), 1000, false);
  EXPECT_EQ(without.of_light, (std::vector<int>{500, 500})) << "a sky that is no source takes none";
  EXPECT_EQ(without.of_sky, 0);
  scene.lights.erase(scene.lights.begin());
  EXPECT_EQ(share_by_power(scene, glm::dvec3(0.0), 1000, false).of_light[0], 1000) << "nothing is within";
}

}  // namespace
}  // namespace volgi::test
