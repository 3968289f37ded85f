// What metals reflect in all, against an integral that knows no polynomial.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/constants.hpp>

#include "shaders/shared/material.shared.h"

namespace volgi {
namespace {

/// Share of even light from everywhere that glTF's conductor of one F0 reflects (appendix B): a sum over both
/// directions, not over microfacets' normals as the polynomials were made.
double reflected(double f0, double roughness) {
  const double alpha2 = std::pow(roughness, 4.0);
  const auto smith = [&](double a, double b) { return a * std::sqrt(b * b * (1.0 - alpha2) + alpha2); };
  constexpr int STEPS = 64;
  double sum = 0.0;
  for (int i = 0; i < STEPS; ++i) {
    const double v = std::sqrt((i + 0.5) / STEPS), across_v = std::sqrt(1.0 - v * v);  // even in v dv
    for (int j = 0; j < STEPS; ++j) {
      const double l = std::sqrt((j + 0.5) / STEPS), across_l = std::sqrt(1.0 - l * l);
      for (int k = 0; k < STEPS; ++k) {
        const double turn = glm::pi<double>() * (k + 0.5) / STEPS;
        const glm::dvec3 view(across_v, 0.0, v), light(across_l * std::cos(turn), across_l * std::sin(turn), l);
        const glm::dvec3 half = glm::normalize(view + light);
        const double d = half.z * half.z * (alpha2 - 1.0) + 1.0;
        const double distribution = alpha2 / (glm::pi<double>() * d * d);
        const double visibility = 0.5 / (smith(v, l) + smith(l, v));
        const double fresnel = f0 + (1.0 - f0) * std::pow(1.0 - glm::dot(view, half), 5.0);
        sum += distribution * visibility * fresnel;
      }
    }
  }
  return sum * glm::pi<double>() / std::pow(double(STEPS), 3.0);
}

TEST(MetalAlbedo, IsTheMeanOverAllDirections) {
  for (const float roughness : {0.5f, 0.7f, 1.0f}) {
    for (const float f0 : {0.04f, 0.5f, 1.0f})
      EXPECT_NEAR(shared::mirror_albedo(glm::vec3(f0), 1.0f, roughness).y, reflected(double(f0), double(roughness)),
                  0.006)
          << roughness << ' ' << f0;
  }
  EXPECT_NEAR(shared::mirror_albedo(glm::vec3(1.0f), 1.0f, 0.0f).x, 1.0f, 0.002f) << "a mirror";
}

shared::Reflectance of(glm::vec3 base, float metallic) {
  return shared::reflectance_of(base, metallic, glm::vec3(0.0f), 0.0f, 0);
}

TEST(MetalAlbedo, SurfacesMixBoth) {
  const glm::vec3 base(0.9f, 0.4f, 0.1f);
  EXPECT_EQ(shared::surface_albedo(of(base, 0.0f), 0.3f), base);
  const glm::vec3 metal = shared::mirror_albedo(base, 1.0f, 0.3f);
  EXPECT_EQ(shared::surface_albedo(of(base, 1.0f), 0.3f), metal);
  // Of the diffuse half the mirror of the other half takes its share.
  const glm::vec3 half = shared::surface_albedo(of(base, 0.5f), 0.3f);
  EXPECT_LT(half.x, 0.5f * (base.x + metal.x));
  EXPECT_GT(half.x, 0.5f * metal.x);
  const shared::Reflectance lambertian = shared::reflectance_of(base, 1.0f, glm::vec3(0.04f), 1.0f, 1);
  EXPECT_EQ(shared::surface_albedo(lambertian, 0.3f), glm::vec3(0.0f));
}

TEST(MetalAlbedo, WhatIsNoMetalLosesToItsMirrorWhatThatTakes) {
  // White plastic reflects no more than it receives, and nearly all of it.
  for (const float roughness : {0.1f, 0.5f, 1.0f}) {
    const auto r = shared::reflectance_of(glm::vec3(1.0f), 0.0f, glm::vec3(0.04f), 1.0f, 0);
    const float albedo = shared::surface_albedo(r, roughness).x;
    EXPECT_LE(albedo, 1.0f) << roughness;
    EXPECT_GT(albedo, 0.95f) << roughness;
  }
}

}  // namespace
}  // namespace volgi
