// The constants of shared/sh.shared.h against quadrature, and what clamp_rescale promises.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <random>

#include "shaders/shared/sh.shared.h"

namespace volgi::shared {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// Integral over the pyramid |y|,|z| <= x of f(direction), midpoint rule over the square at x = 1.
template <class F>
double over_pyramid(const F& f) {
  constexpr int n = 1200;
  double sum = 0.0;
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const double y = (2.0 * i + 1.0) / n - 1.0;
      const double z = (2.0 * j + 1.0) / n - 1.0;
      const double r = std::sqrt(1.0 + y * y + z * z);
      sum += f(glm::dvec3(1.0, y, z) / r) / (r * r * r);
    }
  }
  return sum * 4.0 / (double(n) * n);
}

TEST(PyramidConstants, AgreeWithQuadrature) {
  const double solid_angle = over_pyramid([](glm::dvec3) { return 1.0; });
  const double x = over_pyramid([](glm::dvec3 d) { return d.x; });
  const double xx = over_pyramid([](glm::dvec3 d) { return d.x * d.x; });
  const double yy = over_pyramid([](glm::dvec3 d) { return d.y * d.y; });
  const double xy = over_pyramid([](glm::dvec3 d) { return d.x * d.y; });
  EXPECT_NEAR(solid_angle, 4.0 * kPi / 6.0, 1e-6);
  EXPECT_NEAR(x, 2.0 * std::sqrt(2.0) * std::atan(1.0 / std::sqrt(2.0)), 1e-6);
  EXPECT_NEAR(xx, 2.0 * kPi / 9.0 + 4.0 * std::sqrt(3.0) / 9.0, 1e-6);
  EXPECT_NEAR(xy, 0.0, 1e-9);
  EXPECT_NEAR(PYRAMID_CONSTANT, solid_angle / (4.0 * kPi), 1e-6);
  EXPECT_NEAR(PYRAMID_AXIS, std::sqrt(3.0) / (4.0 * kPi) * x, 1e-6);
  EXPECT_NEAR(PYRAMID_AXIS_AXIS, 3.0 / (4.0 * kPi) * xx, 1e-6);
  EXPECT_NEAR(PYRAMID_TRANSVERSE, 3.0 / (4.0 * kPi) * yy, 1e-6);
}

// The unclamped operators of six pyramids sum to the identity.
TEST(PyramidConstants, TileTheSphere) {
  EXPECT_NEAR(6.0 * double(PYRAMID_CONSTANT), 1.0, 1e-6);
  EXPECT_NEAR(2.0 * double(PYRAMID_AXIS_AXIS) + 4.0 * double(PYRAMID_TRANSVERSE), 1.0, 1e-6);
}

TEST(PyramidPower, IsTheIntegralOfTheLobe) {
  const vec4 lobe(2.0f, 0.3f, -0.7f, 0.9f);  // times sqrt(4 pi): 00, y, z, x
  const auto radiance = [&](glm::dvec3 d) {
    return (double(lobe.x) + std::sqrt(3.0) * (double(lobe.y) * d.y + double(lobe.z) * d.z + double(lobe.w) * d.x)) /
           (4.0 * kPi);
  };
  for (int face = 0; face < 6; ++face) {
    const int axis = face >> 1;
    const double sign = (face & 1) != 0 ? 1.0 : -1.0;
    const double exact = over_pyramid([&](glm::dvec3 d) {
      glm::dvec3 turned(0.0);
      turned[axis] = sign * d.x;
      turned[(axis + 1) % 3] = d.y;
      turned[(axis + 2) % 3] = d.z;
      return radiance(turned);
    });
    EXPECT_NEAR(pyramid_power(lobe, face), exact, 1e-5);
  }
}

double clamped_sum(vec4 lobe) {
  double sum = 0.0;
  for (int face = 0; face < 6; ++face) sum += std::max(double(pyramid_power(lobe, face)), 0.0);
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
    EXPECT_NEAR(clamped_sum(lobe * factor), lobe.x, 1e-5 * std::max(1.0f, lobe.x));
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
    EXPECT_LT(pyramid_power(lobe, face), pyramid_power(lobe, face ^ 1));  // away from the surface
    sum += lobe;
  }
  EXPECT_NEAR(glm::length(sum - vec4(6.0f, 0.0f, 0.0f, 0.0f)), 0.0f, 1e-5f);
}

}  // namespace
}  // namespace volgi::shared
