// What sides send, return and read as irradiance (conventions, "Volume quantities").
#include <gtest/gtest.h>

#include <glm/glm.hpp>

#include "shaders/shared/side.shared.h"

namespace volgi::shared {
namespace {

const vec3 kAlbedos[] = {vec3(0.0f), vec3(0.3f, 0.5f, 0.7f), vec3(0.95f), vec3(1.0f)};
constexpr float kFace = 0.04f;  // m^2
const vec3 kNormals[] = {vec3(0, 1, 0), vec3(0.6f, 0, -0.8f), vec3(0.70710678f, 0.70710678f, 0),
                         vec3(0.57735027f, -0.57735027f, 0.57735027f)};

TEST(Side, NetPowerIsExactOnPlanes) {
  for (const vec3& albedo : kAlbedos) {
    for (const vec3& normal : kNormals) {
      const float area = kFace / staircase_factor(normal);
      const vec3 flux = area * vec3(3.0f, 0.0f, 0.2f);  // A B0
      const vec3 received(0.5f, 0.2f, 0.01f);
      const vec3 sent =
          side_sent_power(flux, albedo, area, kFace) + side_returned_fraction(albedo, area, kFace) * received;
      const vec3 irradiance = side_irradiance(received, flux, albedo, normal, area, kFace);
      const vec3 expected = flux - (vec3(1.0f) - albedo) * area * irradiance;
      for (int band = 0; band < 3; ++band) EXPECT_NEAR(sent[band] - received[band], expected[band], 1e-6f);
    }
  }
}

TEST(Side, BlackSurfaceReturnsNothing) {
  for (float s : {1.0f, 1.3f, 1.7320508f}) EXPECT_EQ(side_returned_fraction(vec3(0.0f), kFace / s, kFace), vec3(0.0f));
}

TEST(Side, NothingReturnsMoreThanItReceives) {
  for (float s : {0.5f, 1.0f, 1.3f, 1.7320508f, 1000.0f}) {
    EXPECT_NEAR(side_returned_fraction(vec3(1.0f), kFace / s, kFace).x, 1.0f, 1e-6f);
    const float some = side_returned_fraction(vec3(0.6f), kFace / s, kFace).x;
    EXPECT_GT(some, 0.0f);
    EXPECT_LT(some, 1.0f);
  }
}

// Isotropic radiance L = B0 / (pi (1-rho)) sends pi L m through the face of any side: the side must send the same back,
// and read pi L.
// Isotropic radiance L = B0 / (pi (1-rho)) sends pi L m through the face of any side: the side must send the same back
// whatever area it stands for, and on planes read pi L.
TEST(Side, FurnaceHoldsAtAnyTilt) {
  for (float rho : {0.0f, 0.5f, 0.95f}) {
    const vec3 albedo(rho);
    const vec3 radiosity(2.0f / (1.0f - rho));
    const vec3 received = kFace * radiosity;
    for (float area : {0.3f * kFace, kFace / 1.7320508f, kFace, 1.6f * kFace}) {
      const vec3 flux(area * 2.0f);
      const vec3 sent =
          side_sent_power(flux, albedo, area, kFace) + side_returned_fraction(albedo, area, kFace) * received;
      EXPECT_NEAR(sent.x / received.x, 1.0f, 2e-6f);
    }
    for (const vec3& normal : kNormals) {
      const float area = kFace / staircase_factor(normal);
      EXPECT_NEAR(side_irradiance(received, vec3(area * 2.0f), albedo, normal, area, kFace).x / radiosity.x, 1.0f,
                  3e-6f);
    }
  }
}

TEST(Side, UprightSurfaceIsPlain) {
  const vec3 albedo(0.4f);
  EXPECT_NEAR(side_sent_power(vec3(2.0f), albedo, kFace, kFace).x, 2.0f, 1e-6f);
  EXPECT_NEAR(side_returned_fraction(albedo, kFace, kFace).x, 0.4f, 1e-7f);
  EXPECT_NEAR(side_irradiance(vec3(0.3f), vec3(2.0f), albedo, vec3(0, 0, 1), kFace, kFace).x, 0.3f / kFace, 1e-5f);
  EXPECT_FLOAT_EQ(staircase_factor(glm::normalize(vec3(1, -1, 1))), 1.7320508f);
}

TEST(Side, BitsOfACell) {
  const uvec2 cell(40u, 0b000010'00'101010u | (0b001000u << 8));
  int expected = 40;
  for (int face = 0; face < 6; ++face) {
    EXPECT_EQ(has_side(cell, face), ((cell.y >> face) & 1u) != 0u);
    if (!has_side(cell, face)) continue;
    EXPECT_EQ(int(side_index(cell, face)), expected++);
  }
  EXPECT_TRUE(is_opaque(cell, 3));
  EXPECT_FALSE(is_opaque(cell, 5));
}

}  // namespace
}  // namespace volgi::shared
