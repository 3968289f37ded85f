#include "propagation/ordinates.h"

#include <gtest/gtest.h>

#include <glm/gtc/constants.hpp>

#include "core/error.h"

namespace volgi {
namespace {

struct Expected {
  int directions;
  double t_over_pi;  // docs/theory.md#ordinates
};
constexpr Expected kSets[] = {{8, 1.155}, {24, 1.086}, {48, 1.027}};

TEST(OrdinateSet, WeightsSumToTheSphere) {
  for (const Expected& e : kSets) {
    const OrdinateSet set = ordinate_set(e.directions);
    ASSERT_EQ(int(set.directions.size()) * 8, e.directions);
    ASSERT_EQ(set.weights.size(), set.directions.size());
    double sum = 0.0;
    for (float w : set.weights) {
      EXPECT_GT(w, 0.0f);
      sum += 8.0 * double(w);
    }
    EXPECT_NEAR(sum / (4.0 * glm::pi<double>()), 1.0, 1e-6);
  }
}

// First moment over a half space on every axis: what makes a furnace exact; second moments are those of the sphere.
TEST(OrdinateSet, Moments) {
  for (const Expected& e : kSets) {
    const OrdinateSet set = ordinate_set(e.directions);
    glm::dvec3 first(0.0), second(0.0);
    for (size_t i = 0; i < set.directions.size(); ++i) {
      const glm::dvec3 d(set.directions[i]);
      EXPECT_NEAR(glm::length(d), 1.0, 1e-6);
      EXPECT_TRUE(glm::all(glm::greaterThan(d, glm::dvec3(0.01)))) << "never along an axis";
      first += 4.0 * double(set.weights[i]) * d;
      second += 8.0 * double(set.weights[i]) * d * d;
    }
    EXPECT_NEAR(double(set.t) / glm::pi<double>(), e.t_over_pi, 6e-4);
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(first[axis] / double(set.t), 1.0, 1e-6);
      EXPECT_NEAR(second[axis] / (4.0 * glm::pi<double>() / 3.0), 1.0, 1e-5);
    }
  }
}

// With every direction all permutations of its axes, and the same weight: a turned volume gives the same numbers.
TEST(OrdinateSet, IsSymmetric) {
  for (const Expected& e : kSets) {
    const OrdinateSet set = ordinate_set(e.directions);
    for (size_t i = 0; i < set.directions.size(); ++i) {
      const glm::vec3 d = set.directions[i];
      for (glm::vec3 turned :
           {glm::vec3(d.y, d.z, d.x), glm::vec3(d.z, d.x, d.y), glm::vec3(d.y, d.x, d.z), glm::vec3(d.x, d.z, d.y)}) {
        bool found = false;
        for (size_t j = 0; j < set.directions.size(); ++j) {
          found = found || (glm::distance(set.directions[j], turned) < 1e-6f && set.weights[j] == set.weights[i]);
        }
        EXPECT_TRUE(found) << e.directions << " directions";
      }
    }
  }
}

TEST(OrdinateSet, RefusesOthers) {
  for (int n : {0, 7, 26, -8}) EXPECT_THROW(ordinate_set(n), Error) << n;
}

TEST(OrdinateSet, FinerGridsTakeMoreDirections) {
  EXPECT_EQ(directions_for_grid({16, 8, 16}), 24);
  EXPECT_EQ(directions_for_grid({17, 8, 16}), 48);
}

}  // namespace
}  // namespace volgi
