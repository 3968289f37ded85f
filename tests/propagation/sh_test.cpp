// The constants of shared/sh.shared.h against quadrature, and what clamp_rescale promises.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <random>

#include "shaders/shared/sh.shared.h"
#include "tests/propagation/pulse_rooms.h"

namespace volgi::shared {
namespace {

constexpr double kPi = 3.14159265358979323846;

double passed_sum(vec4 lobe) {
  double sum = 0.0;
  for (int face = 0; face < 6; ++face) sum += double(flux_passed(lobe, face));
  return sum;
}

TEST(ClampRescale, FacePowersSumToThePowerOfTheLobe) {
  std::mt19937 random(7);
  std::normal_distribution<float> normal;
  for (int i = 0; i < 2000; ++i) {
    const vec4 lobe(std::abs(normal(random)), 3.0f * normal(random), 3.0f * normal(random), 3.0f * normal(random));
    const float factor = clamp_rescale(lobe);
    EXPECT_GT(factor, 0.0f);
    EXPECT_LE(factor, 1.000001f);  // clamping only adds
    EXPECT_NEAR(passed_sum(lobe * factor), lobe.x, 1e-5 * std::max(1.0f, lobe.x));
  }
}

TEST(ClampRescale, LeavesMildLobesAlone) {
  EXPECT_NEAR(clamp_rescale(vec4(1.0f, 0.0f, 0.0f, 0.0f)), 1.0f, 1e-6f);
  EXPECT_NEAR(clamp_rescale(vec4(1.0f, 0.2f, -0.3f, 0.3f)), 1.0f, 1e-6f);
  EXPECT_EQ(clamp_rescale(vec4(0.0f)), 0.0f);
}

TEST(SideLobe, SixMakeIsotropicLight) {
  vec4 sum(0.0f);
  for (int face = 0; face < 6; ++face) {
    const vec4 lobe = side_lobe(face);
    EXPECT_EQ(lobe.x, 1.0f);
    EXPECT_LT(flux_power(lobe, face), 0.0f);  // away from the surface
    EXPECT_GT(flux_power(lobe, face ^ 1), 0.38f);
    sum += lobe;
  }
  EXPECT_NEAR(glm::length(sum - vec4(6.0f, 0.0f, 0.0f, 0.0f)), 0.0f, 1e-5f);
}

// What of a side's light has crossed a face sideways has exactly no power to pass backwards, but for rounding.
TEST(SideLobe, NothingTurnsBack) {
  const float along = 6.0f * FLUX_10;
  for (int face = 0; face < 6; ++face) {
    const vec4 lobe = side_lobe(face);
    EXPECT_EQ(flux_passed(lobe, face), 0.0f);
    vec4 aside = FLUX_ACROSS_11 * lobe;
    aside.x = FLUX_00;
    aside[sh_component(((face >> 1) + 1) % 3)] = FLUX_10;
    EXPECT_NEAR(aside[sh_component(face >> 1)], (face & 1) != 0 ? -0.125f * along : 0.125f * along, 1e-6f);
    EXPECT_NEAR(flux_power(aside, face), 0.0f, 1e-7f);
    EXPECT_EQ(flux_passed(aside, face), 0.0f);
  }
}

using test::basis_at;
using test::over_sphere;

TEST(Basis, IsOrthonormalAndAsTheDefinitions) {
  double products[9][9] = {};
  double worst = 0.0;
  over_sphere([&](glm::dvec3 d, double solid_angle) {
    double b[9];
    basis_at(d, b);
    const vec4 low = sh_basis_1(vec3(d)), mid = sh_basis_2(vec3(d));
    const float mine[9] = {low.x, low.y, low.z, low.w, mid.x, mid.y, mid.z, mid.w, sh_basis_22(vec3(d))};
    for (int i = 0; i < 9; ++i) {
      worst = std::max(worst, std::abs(b[i] - double(mine[i])));
      for (int j = 0; j < 9; ++j) products[i][j] += solid_angle / (4.0 * kPi) * b[i] * b[j];
    }
  });
  EXPECT_LT(worst, 2e-6);
  for (int i = 0; i < 9; ++i) {
    for (int j = 0; j < 9; ++j) EXPECT_NEAR(products[i][j], i == j ? 1.0 : 0.0, 2e-5) << i << " " << j;
  }
}

// (1/4 pi) int_{z>0} z Y_i Y_j over (1/4 pi) int s Y_i^2, s = |x|+|y|+|z|.
TEST(FluxConstants, AgreeWithQuadrature) {
  double flux[9][9] = {}, shown[9][9] = {};
  over_sphere([&](glm::dvec3 d, double solid_angle) {
    double b[9];
    basis_at(d, b);
    const double s = std::abs(d.x) + std::abs(d.y) + std::abs(d.z);
    for (int i = 0; i < 9; ++i) {
      for (int j = 0; j < 9; ++j) {
        flux[i][j] += std::max(d.z, 0.0) * solid_angle / (4.0 * kPi) * b[i] * b[j];
        shown[i][j] += s * solid_angle / (4.0 * kPi) * b[i] * b[j];
      }
    }
  });
  for (int i = 0; i < 9; ++i) {
    for (int j = 0; j < 9; ++j) {
      if (i == j) continue;  // so that the projection needs no inverse
      EXPECT_NEAR(shown[i][j], 0.0, 2e-5);
    }
  }
  EXPECT_NEAR(shown[0][0], 1.5, 2e-5);
  EXPECT_NEAR(shown[3][3], 1.5, 2e-5);
  EXPECT_NEAR(shown[4][4], 25.0 / 16.0, 5e-5);
  EXPECT_NEAR(shown[6][6], 45.0 / 32.0, 5e-5);
  const int zonal[3] = {0, 2, 6};
  const float expected[3][3] = {{FLUX_00, FLUX_01, FLUX_02}, {FLUX_10, FLUX_11, FLUX_12}, {FLUX_20, FLUX_21, FLUX_22}};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j)
      EXPECT_NEAR(flux[zonal[i]][zonal[j]] / shown[zonal[i]][zonal[i]], double(expected[i][j]), 2e-5) << i << j;
  }
  const auto element = [&](int i, int j) { return flux[i][j] / shown[i][i]; };
  for (const auto& [one, two] : {std::pair{3, 7}, std::pair{1, 5}}) {
    EXPECT_NEAR(element(one, one), double(FLUX_ACROSS_11), 2e-5);
    EXPECT_NEAR(element(one, two), double(FLUX_ACROSS_12), 2e-5);
    EXPECT_NEAR(element(two, one), double(FLUX_ACROSS_21), 2e-5);
    EXPECT_NEAR(element(two, two), double(FLUX_ACROSS_22), 2e-5);
  }
  EXPECT_NEAR(element(8, 8), double(FLUX_TWIN), 2e-5);
  EXPECT_NEAR(element(4, 4), double(FLUX_DIAGONAL), 2e-5);
  EXPECT_NEAR(element(3, 0), 0.0, 1e-6);
}

Lobe9 random_lobe(std::mt19937& random) {
  std::normal_distribution<float> normal;
  Lobe9 l;
  l.low = vec4(1.0f, normal(random), normal(random), normal(random));
  l.mid = vec4(normal(random), normal(random), normal(random), normal(random));
  l.high = normal(random);
  return l;
}

TEST(Lobe9, PowersTurnAndSum) {
  std::mt19937 random(3);
  for (int i = 0; i < 500; ++i) {
    Lobe9 l = random_lobe(random);
    const vec2 p(l.mid.z, l.high);
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(glm::length(from_axis(about_axis(p, axis), axis) - p), 0.0f, 1e-5f);
    }
    float sum = 0.0f;
    for (int face = 0; face < 6; ++face) sum += flux_power(l, face);
    EXPECT_NEAR(sum, l.low.x, 1e-5f);  // unclamped, all six: the lobe's power
    const float factor = clamp_rescale(l);
    l = {factor * l.low, factor * l.mid, factor * l.high};
    float passed = 0.0f;
    for (int face = 0; face < 6; ++face) passed += flux_passed(l, face);
    EXPECT_NEAR(passed, 1.0f, 1e-5f);
  }
}

TEST(Lobe9, SixSidesMakeIsotropicLight) {
  Lobe9 sum{vec4(0.0f), vec4(0.0f), 0.0f};
  for (int face = 0; face < 6; ++face) {
    const Lobe9 l = side_lobe_9(face);
    sum.low += l.low;
    sum.mid += l.mid;
    sum.high += l.high;
    EXPECT_NEAR(flux_power(l, face), 0.0f, 1e-6f);  // nothing backwards
    EXPECT_EQ(flux_passed(l, face), 0.0f);
    EXPECT_GT(flux_power(l, face ^ 1), 0.4f);
  }
  EXPECT_NEAR(glm::length(sum.low - vec4(6.0f, 0.0f, 0.0f, 0.0f)), 0.0f, 1e-5f);
  EXPECT_NEAR(glm::length(sum.mid), 0.0f, 1e-5f);
  EXPECT_NEAR(sum.high, 0.0f, 1e-5f);
}

// Zonal coefficients of the papers' lobes, and the numbers as Gaitatzes 2010 has them.
TEST(PaperConstants, AgreeWithQuadrature) {
  double cosine[3] = {}, cone[3] = {};
  constexpr int n = 200000;
  for (int i = 0; i < n; ++i) {
    const double t = (i + 0.5) / n;  // 2 pi dt is the solid angle
    const double legendre[3] = {1.0, t, 1.5 * t * t - 0.5};
    for (int l = 0; l < 3; ++l) {
      cosine[l] += 2.0 * kPi / n * t / kPi * legendre[l];
      if (t > std::sqrt(0.5)) cone[l] += 2.0 * kPi / n * legendre[l];
    }
  }
  EXPECT_NEAR(cosine[0], 1.0, 1e-6);
  EXPECT_NEAR(cosine[1], double(COSINE_ZONAL_1), 1e-6);
  EXPECT_NEAR(cosine[2], double(COSINE_ZONAL_2), 1e-6);
  EXPECT_NEAR(cone[0] / (4.0 * kPi), double(CONE_SHARE), 1e-5);
  EXPECT_NEAR(cone[1] / cone[0], double(CONE_ZONAL_1), 1e-5);
  EXPECT_NEAR(cone[2] / cone[0], double(CONE_ZONAL_2), 1e-5);
  const double share = 2.0 * std::sqrt(kPi) * double(CONE_SHARE);
  EXPECT_NEAR(share, std::sqrt(kPi) * (1.0 - std::cos(kPi / 4.0)), 1e-6);
  EXPECT_NEAR(share * std::sqrt(3.0) * double(CONE_ZONAL_1), std::sqrt(3.0 * kPi) / 2.0 * 0.5, 1e-6);
  EXPECT_NEAR(share * std::sqrt(5.0) * double(CONE_ZONAL_2), std::sqrt(5.0 * kPi) / 2.0 * std::sqrt(0.5) * 0.5, 1e-6);
}

TEST(PaperConstants, LpvSolidAngles) {
  EXPECT_NEAR(double(LPV_FAR_SOLID_ANGLE) + 4.0 * double(LPV_SIDE_SOLID_ANGLE), 4.0 * kPi / 6.0, 1e-6);
  EXPECT_NEAR(double(LPV_SIDE_SOLID_ANGLE), kPi / 6.0 - std::asin(0.1), 1e-7);
  // Quadrature over the side face x in (1/2, 3/2), y = 1/2, z in (-1/2, 1/2) seen from the origin.
  double side = 0.0;
  constexpr int n = 400;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const double x = 0.5 + (i + 0.5) / n, z = (j + 0.5) / n - 0.5;
      side += 0.5 / std::pow(x * x + 0.25 + z * z, 1.5) / double(n * n);
    }
  }
  EXPECT_NEAR(side, double(LPV_SIDE_SOLID_ANGLE), 1e-5);
  EXPECT_NEAR(double(LPV_SIDE_ALONG), 2.0 / std::sqrt(5.0), 1e-7);
  EXPECT_NEAR(double(LPV_SIDE_ACROSS), 1.0 / std::sqrt(5.0), 1e-7);
}

TEST(PaperConstants, SurfacesTurnBackWhatHeadsIntoThem) {
  const vec3 n(0.2f, -0.9f, 0.3f);
  EXPECT_EQ(nearest_axis(n), 1);
  EXPECT_TRUE(turned_back(n, 1, 1.0f));
  EXPECT_FALSE(turned_back(n, 1, -1.0f));
  EXPECT_FALSE(turned_back(n, 0, -1.0f));
  EXPECT_TRUE(turned_back(vec3(0.0f), 2, 1.0f));
  EXPECT_EQ(nearest_axis(vec3(1.0f, -1.0f, 1.0f)), 0);
}

// Isotropic radiance L: the cell's lobes carry 6 pi L h^2.
TEST(RadianceFromLobe, OfIsotropicLight) {
  const double h = 0.3, radiance = 2.0;
  const auto power = float(6.0 * kPi * radiance * h * h);
  EXPECT_NEAR(double(radiance_from_lobe(float(h)) * power), std::sqrt(4.0 * kPi) * radiance, 1e-5);
}

}  // namespace
}  // namespace volgi::shared
