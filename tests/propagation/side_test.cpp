// What sides send, return and read as irradiance (docs/conventions.md#volume-quantities).
#include <gtest/gtest.h>

#include <glm/glm.hpp>

#include "shaders/shared/side.shared.h"

namespace volgi::shared {
namespace {

const vec3 kAlbedos[] = {vec3(0.0f), vec3(0.3f, 0.5f, 0.7f), vec3(0.95f), vec3(1.0f)};
constexpr float kFace = 0.04f;  // m^2
const vec3 kNormals[] = {vec3(0, 1, 0), vec3(0.6f, 0, -0.8f), vec3(0.70710678f, 0.70710678f, 0),
                         vec3(0.57735027f, -0.57735027f, 0.57735027f)};

/// Calls visit(axis, share of the faces) for the families of a plane.
template <class Visit>
void for_families(const vec3& normal, const Visit& visit) {
  for (int axis = 0; axis < 3; ++axis) visit(axis, std::abs(normal[axis]) / staircase_factor(normal));
}

// A plane whose irradiance is E everywhere: each family receives its share of the world and of the plane's own light,
// reads E, and the plane's net power is A (B0 - (1-rho) E).
TEST(Side, NetPowerIsExactOnPlanes) {
  const vec3 irradiance(3.0f, 1.0f, 0.1f);
  for (const vec3& albedo : kAlbedos) {
    for (const vec3& normal : kNormals) {
      const float area = kFace / staircase_factor(normal);
      const vec3 flux = area * vec3(3.0f, 0.0f, 0.2f);  // A B0
      vec3 net(0.0f);
      for_families(normal, [&](int axis, float share) {
        const vec3 received = area * (staircase_world_share(normal, axis) * irradiance +
                                      staircase_own_share(normal, axis) * (flux / area + albedo * irradiance));
        const vec3 read = side_irradiance(received, flux, albedo, normal, axis, area, kFace);
        for (int band = 0; band < 3; ++band) EXPECT_NEAR(read[band], irradiance[band], 1e-5f);
        net += share * (side_sent_power(flux, albedo, area, kFace) +
                        (side_returned_fraction(albedo, area, kFace) - 1.0f) * received);
      });
      const vec3 expected = flux - (vec3(1.0f) - albedo) * area * irradiance;
      for (int band = 0; band < 3; ++band) EXPECT_NEAR(net[band], expected[band], 1e-6f);
    }
  }
}

// On black planes, whatever each family receives: E is their mean by side_weight().
TEST(Side, NetPowerIsExactInTheMeanOverBlackFaces) {
  for (const vec3& normal : kNormals) {
    const float area = kFace / staircase_factor(normal);
    const vec3 flux(area * 3.0f);
    float net = 0.0f, irradiance = 0.0f, weights = 0.0f;
    for_families(normal, [&](int axis, float share) {
      const vec3 received(0.5f + 0.3f * float(axis));
      const float weight = share * side_weight(normal, axis, area);
      irradiance += weight * side_irradiance(received, flux, vec3(0.0f), normal, axis, area, kFace).x;
      weights += weight;
      net += share * (side_sent_power(flux, vec3(0.0f), area, kFace).x - received.x);
    });
    EXPECT_NEAR(weights, area, 1e-6f);
    EXPECT_NEAR(net, flux.x - area * irradiance / weights, 2e-6f);
  }
}

// Half of a step's view is its tread, however slightly the wall is turned; the tread hardly sees the step.
TEST(Side, StepsOfSlightlyTurnedWallsAreWalledIn) {
  const vec3 normal = glm::normalize(vec3(0.01f, 1.0f, 0.0f));
  EXPECT_NEAR(staircase_own_share(normal, 0), 0.5f, 0.01f);
  EXPECT_NEAR(staircase_own_share(normal, 1), 0.005f, 0.0005f);
  EXPECT_EQ(staircase_own_share(vec3(0, 0, -1), 2), 0.0f);
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
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(side_irradiance(received, vec3(area * 2.0f), albedo, normal, axis, area, kFace).x / radiosity.x,
                    1.0f, 3e-6f);
      }
    }
  }
}

TEST(Side, UprightSurfaceIsPlain) {
  const vec3 albedo(0.4f);
  EXPECT_NEAR(side_sent_power(vec3(2.0f), albedo, kFace, kFace).x, 2.0f, 1e-6f);
  EXPECT_NEAR(side_returned_fraction(albedo, kFace, kFace).x, 0.4f, 1e-7f);
  EXPECT_NEAR(side_irradiance(vec3(0.3f), vec3(2.0f), albedo, vec3(0, 0, 1), 2, kFace, kFace).x, 0.3f / kFace, 1e-5f);
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
