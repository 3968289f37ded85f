#include "propagation/ordinates.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/constants.hpp>
#include <utility>

#include "core/error.h"

namespace volgi {
namespace {

struct Expected {
  int directions;
  double t_over_pi;  // docs/theory.md#ordinates
};
constexpr Expected kSets[] = {{8, 1.155}, {24, 1.086}, {48, 1.0265}, {80, 1.017}, {128, 1.0106}};

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

// The 128 and the 512 again: the octant halved twice, and three times, along great circles, each triangle its area and
// mean.
class Triangles {
 public:
  explicit Triangles(int times) { split({1, 0, 0}, {0, 1, 0}, {0, 0, 1}, times); }
  std::vector<std::pair<glm::dvec3, double>> all;  // mean direction, area [sr]

 private:
  void split(glm::dvec3 a, glm::dvec3 b, glm::dvec3 c, int times) {
    if (times == 0) return add(a, b, c);
    const glm::dvec3 ab = glm::normalize(a + b), bc = glm::normalize(b + c), ca = glm::normalize(c + a);
    split(a, ab, ca, times - 1);
    split(ab, b, bc, times - 1);
    split(ca, bc, c, times - 1);
    split(ab, bc, ca, times - 1);
  }
  void add(glm::dvec3 a, glm::dvec3 b, glm::dvec3 c) {
    glm::dvec3 mean(0.0);  // Lambert: half the sum over edges of their angle times the normal of their plane
    for (auto [p, q] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) {
      mean += 0.5 * std::acos(glm::dot(p, q)) * glm::normalize(glm::cross(p, q));
    }
    const double area =
        2.0 * std::atan2(glm::dot(a, glm::cross(b, c)), 1.0 + glm::dot(a, b) + glm::dot(b, c) + glm::dot(c, a));
    all.emplace_back(glm::normalize(mean), area);
  }
};

TEST(OrdinateSet, GeodesicTriangles) {
  for (const int times : {2, 3}) {
    const OrdinateSet set = ordinate_set(8 << (2 * times));
    for (const auto& [direction, area] : Triangles(times).all) {
      int found = 0;
      for (size_t i = 0; i < set.directions.size(); ++i) {
        if (glm::distance(glm::dvec3(set.directions[i]), direction) > 1e-6) continue;
        EXPECT_NEAR(double(set.weights[i]), area, 1e-6);
        ++found;
      }
      EXPECT_EQ(found, 1);
    }
  }
}

constexpr Ordinates kRules[] = {Ordinates::step, Ordinates::characteristic};

TEST(CellTransfer, ConservesAndIsReciprocal) {
  for (Ordinates rule : kRules) {
    for (int directions : {8, 24, 48, 80, 128, 512}) {
      for (glm::vec3 d : ordinate_set(directions).directions) {
        const CellTransfer transfer = cell_transfer(rule, d);
        for (int in = 0; in < 3; ++in) {
          double sum = 0.0;
          for (int out = 0; out < 3; ++out) {
            EXPECT_GE(transfer.share[in][out], 0.0f);
            EXPECT_NEAR(d[in] * transfer.share[in][out], d[out] * transfer.share[out][in], 1e-7f);
            sum += double(transfer.share[in][out]);
          }
          EXPECT_NEAR(sum, 1.0, 1e-6);
        }
        // Uniform light stays uniform: as much leaves through each face as comes in opposite.
        const glm::vec3 out = transfer.share * d;
        EXPECT_LT(glm::distance(out, d), 1e-6f);
        EXPECT_NEAR(glm::dot(transfer.track, d), 1.0f, 1e-6f);
      }
    }
  }
}

// Rays from a fine lattice on each upwind face, followed through the cell.
TEST(CellTransfer, CharacteristicIsTheExactOverlap) {
  constexpr int kLattice = 400;
  for (glm::dvec3 d : {glm::dvec3(0.3, 0.5, 0.9), {0.6, 0.6, 0.5}, {0.98, 0.1, 0.15}, {0.57735, 0.57735, 0.57735}}) {
    d = glm::normalize(d);
    const CellTransfer transfer = cell_transfer(Ordinates::characteristic, glm::vec3(d));
    for (int in = 0; in < 3; ++in) {
      glm::dvec3 share(0.0);
      double track = 0.0;
      for (int i = 0; i < kLattice * kLattice; ++i) {
        const int column = i % kLattice, row = i / kLattice;
        glm::dvec3 to_face(1.0);  // along each axis, in cell edges
        to_face[(in + 1) % 3] = (column + 0.5) / kLattice;
        to_face[(in + 2) % 3] = (row + 0.5) / kLattice;
        const glm::dvec3 length = to_face / d;
        const int out = length.x <= length.y && length.x <= length.z ? 0 : length.y <= length.z ? 1 : 2;
        share[out] += 1.0 / (kLattice * kLattice);
        track += length[out] / (kLattice * kLattice);
      }
      for (int out = 0; out < 3; ++out) EXPECT_NEAR(double(transfer.share[in][out]), share[out], 3e-3) << in << out;
      EXPECT_NEAR(double(transfer.track[in]), track, 3e-3);
    }
  }
}

TEST(CellTransfer, StepHandsOnInProportion) {
  const glm::vec3 d = glm::normalize(glm::vec3(1.0f, 2.0f, 4.0f));
  const CellTransfer transfer = cell_transfer(Ordinates::step, d);
  for (int in = 0; in < 3; ++in) {
    EXPECT_NEAR(transfer.share[in].y / transfer.share[in].x, 2.0f, 1e-6f);
    EXPECT_NEAR(transfer.share[in].z / transfer.share[in].x, 4.0f, 1e-6f);
  }
}

// Isotropic radiance L: (pi/t) w_d d_a L h^2 through each face; read out it is L times the weight again.
TEST(RadiancePerWatt, ReadsIsotropicLight) {
  const float h = 0.3f, radiance = 2.5f;
  for (Ordinates rule : kRules) {
    for (int directions : {8, 24, 48, 80, 128}) {
      const OrdinateSet set = ordinate_set(directions);
      for (size_t i = 0; i < set.directions.size(); ++i) {
        const glm::vec3 power = glm::pi<float>() * radiance * h * h * set.emitted_share(i);
        const float read = glm::dot(power, radiance_per_watt(set, i, rule, h));
        EXPECT_NEAR(read / (radiance * set.weights[i]), 1.0f, 1e-5f);
      }
    }
  }
}

TEST(OrdinateSet, RefusesOthers) {
  for (int n : {0, 7, 26, -8}) EXPECT_THROW(ordinate_set(n), Error) << n;
}

TEST(ChooseOrdinates, FollowsTheGridAndWhatIsAskedFor) {
  const SchemeOptions nothing;
  EXPECT_EQ(choose_ordinates({16, 8, 16}, nothing).directions, 24);
  EXPECT_EQ(choose_ordinates({16, 8, 16}, nothing).rule, Ordinates::step);
  EXPECT_EQ(choose_ordinates({8, 32, 8}, nothing).directions, 128);
  EXPECT_EQ(choose_ordinates({8, 32, 8}, nothing).rule, Ordinates::step);
  EXPECT_EQ(choose_ordinates({8, 8, 33}, nothing).directions, 128);
  EXPECT_EQ(choose_ordinates({128, 8, 8}, nothing).directions, 128);
  EXPECT_EQ(choose_ordinates({128, 8, 8}, nothing).rule, Ordinates::characteristic);
  EXPECT_EQ(directions_for_grid({128, 8, 8}), 128);

  SchemeOptions few;
  few.directions = 8;
  EXPECT_EQ(choose_ordinates({64, 64, 64}, few).directions, 8);
  EXPECT_EQ(choose_ordinates({64, 64, 64}, few).rule, Ordinates::step);
  SchemeOptions sharp;
  sharp.ordinates = Ordinates::characteristic;
  EXPECT_EQ(choose_ordinates({16, 16, 16}, sharp).directions, 128);
  SchemeOptions both;
  both.directions = 80;
  both.ordinates = Ordinates::step;
  EXPECT_EQ(choose_ordinates({16, 16, 16}, both).directions, 80);
  EXPECT_EQ(choose_ordinates({16, 16, 16}, both).rule, Ordinates::step);
}

TEST(ChooseOrdinates, SourcesHaveMoreWhereAllHave128) {
  SchemeOptions options;
  EXPECT_FALSE(choose_source_ordinates(glm::ivec3(48), options));
  options.many_for_sources = true;
  const std::optional<OrdinateChoice> sources = choose_source_ordinates(glm::ivec3(48), options);
  ASSERT_TRUE(sources);
  EXPECT_EQ(sources->directions, 512);
  EXPECT_EQ(sources->rule, Ordinates::characteristic);
  EXPECT_FALSE(choose_source_ordinates(glm::ivec3(16), options));
  options.directions = 48;
  EXPECT_FALSE(choose_source_ordinates(glm::ivec3(48), options));
}

}  // namespace
}  // namespace volgi
