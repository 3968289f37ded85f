#include "shaders/shared/disk_to_point.shared.h"

#include <gtest/gtest.h>

#include "tests/support/disk_to_point.h"

namespace volgi::test {
namespace {

struct Place {
  const char* name;
  glm::dvec3 x, n;
};

double found(const Place& p, double area_m2) {
  const glm::dvec3 w = -p.x;
  return double(shared::disk_to_point(float(p.x.y), float(glm::dot(w, p.n)), float(-p.n.y), float(glm::dot(w, w)),
                                      float(area_m2)));
}

const glm::dvec3 kUp(0, 1, 0);
const Place kPlaces[] = {
    {"on the axis", {0, 1, 0}, {0, -1, 0}},
    {"beside the axis", {0.7, 1, 0.4}, {0, -1, 0}},
    {"a wall", {1, 0.5, 0}, {-1, 0, 0}},
    {"low on a wall", {1, 0.05, 0}, {-1, 0, 0}},
    {"askew", {0.8, 0.6, -0.3}, glm::normalize(glm::dvec3(-0.5, -0.6, 0.4))},
    {"turned away from the disk's plane", {0.9, 0.3, 0}, glm::normalize(glm::dvec3(-0.9, 0.3, 0.1))},
    {"far", {20, 15, 3}, glm::normalize(glm::dvec3(-1, -0.5, 0.2))},
};

/// A disk about the origin, from one that is hardly larger than a point to one that reaches as far as the points. A
/// sum over 400 x 400 parts of it errs by less than 2e-5 where it is not nearer than a tenth of its radius.
TEST(DiskToPoint, IsTheIntegralOverTheDisk) {
  for (const Place& p : kPlaces) {
    for (const double area_m2 : {1e-6, 0.01, 0.3, 1.0, 2.5}) {
      const double exact = disk_to_point_summed(p.x, p.n, glm::dvec3(0.0), kUp, area_m2);
      EXPECT_NEAR(found(p, area_m2) / exact, 1.0, 2e-4) << p.name << ", area " << area_m2;
      EXPECT_NEAR(disk_to_point_exact(p.x, p.n, glm::dvec3(0.0), kUp, area_m2) / exact, 1.0, 2e-4) << p.name;
    }
  }
}

/// A wall sees grazing light, of which Nichols' form loses twice A / (pi d^2) to second order.
/// As disk_to_point(), from points that a horizon leaves all of the disk: as much as the header says.
TEST(DiskToPoint, FromAfar) {
  for (const auto& [areas, limit] : {std::pair(double(DISK_FAR_AREAS), 0.015), {2.0 * double(DISK_FAR_AREAS), 0.005}}) {
    const double radius = std::sqrt(1.0 / areas / glm::pi<double>());
    double worst = 0.0;
    for (int i = 0; i < 20000; ++i) {
      const glm::dvec3 n = glm::normalize(glm::dvec3(std::sin(17.0 * i), std::cos(5.0 * i), std::sin(3.0 * i + 1.0)));
      const glm::dvec3 x =
          glm::normalize(glm::dvec3(std::cos(i), 0.01 + std::abs(std::sin(7.0 * i)), std::sin(2.0 * i)));
      const double along = -glm::dot(x, n);
      if (along < radius) continue;
      const double near = found({"", x, n}, 1.0 / areas);
      const double far =
          double(shared::disk_to_point_from_afar(float(x.y), float(along), float(-n.y), 1.0f, float(1.0 / areas)));
      worst = std::max(worst, std::abs(far / near - 1.0));
    }
    EXPECT_LT(worst, limit) << areas;
    EXPECT_GT(worst, 0.5 * limit) << areas;
  }
}

TEST(DiskToPoint, InACornerMoreThanOnTheAxis) {
  const Place wall{"low on a wall", {1, 0.05, 0}, {-1, 0, 0}};
  const double area_m2 = 0.1, squared = glm::dot(wall.x, wall.x);
  const double cosines = 1.0 * 0.05 / squared;
  const double nichols = cosines / (glm::pi<double>() * squared + area_m2);
  const double q = area_m2 / (glm::pi<double>() * squared);
  EXPECT_NEAR(found(wall, area_m2) / nichols, (1.0 + q) * (1.0 + q), 3.0 * q * q);
}

/// All of a large disk's flux arrives where a point touches its middle, and nothing on the horizon or behind it.
TEST(DiskToPoint, IsBounded) {
  for (const double area_m2 : {1e-4, 1.0, 1e4}) {
    const double radius = std::sqrt(area_m2 / glm::pi<double>());
    for (const double height : {2e-3, 1e-2, 0.1}) {
      const Place above{"", {0, height * radius, 0}, {0, -1, 0}};
      EXPECT_NEAR(found(above, area_m2) * area_m2, 1.0 / (1.0 + height * height), 1e-4) << area_m2 << " " << height;
    }
    EXPECT_EQ(found({"the other side of a sheet", {0.3 * radius, 0.9e-3 * radius, 0}, {0, -1, 0}}, area_m2), 0.0);
    for (int i = 0; i < 2000; ++i) {
      const double t = i / 2000.0, far = std::sqrt(area_m2) * std::pow(10.0, 6.0 * t - 4.0);
      const glm::dvec3 n = glm::normalize(glm::dvec3(std::sin(17.0 * i), std::cos(5.0 * i), std::sin(3.0 * i + 1.0)));
      const glm::dvec3 x =
          far * glm::normalize(glm::dvec3(std::cos(i), 0.001 + std::abs(std::sin(7.0 * i)), std::sin(2.0 * i)));
      const double e = found({"", x, n}, area_m2);
      ASSERT_TRUE(std::isfinite(e) && e >= 0.0 && e * area_m2 <= 1.0001) << i;
    }
    EXPECT_EQ(shared::disk_to_point(0.0f, 0.0f, 0.0f, 0.0f, float(area_m2)) * 0.0f, 0.0f) << "finite";
  }
  EXPECT_EQ(shared::disk_to_point(0.0f, 0.0f, 0.0f, 0.0f, 0.0f) * 0.0f, 0.0f) << "finite";
}

}  // namespace
}  // namespace volgi::test
