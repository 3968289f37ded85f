// Points that stand for surfaces in shadow maps: evenly by area, in every aligned run, and where the surfaces are.
#include "core/occluder_points.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/volume_scenes.h"

namespace volgi::test {
namespace {

constexpr int kCount = 4096;

/// Two quads in z = 0 and z = 1, of 1 and of 3 square metres.
Scene two_quads() {
  Scene scene;
  add_quad(scene, add_material(scene, glm::vec3(0.5f)), {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  add_quad(scene, 0, {0, 0, 1}, {3, 0, 0}, {0, 1, 0});
  update_bounds(scene);
  return scene;
}

TEST(OccluderPoints, EvenByAreaInEveryAlignedRun) {
  const OccluderPoints occluders(two_quads(), kCount);
  const auto& points = occluders.points();
  ASSERT_EQ(points.size(), size_t(kCount));
  for (int run = 256; run <= kCount; run *= 4) {
    for (int first = 0; first < kCount; first += run) {
      int of_first = 0;
      std::array<int, 12> squares{};  // of the larger quad, 0.5 x 0.5 m
      for (int i = first; i < first + run; ++i) {
        const shared::OccluderPoint& p = points[size_t(i)];
        EXPECT_FLOAT_EQ(p.area_m2, 4.0f / kCount);
        EXPECT_NEAR(std::abs(p.normal.z), 1.0f, 1e-6f);
        of_first += p.position.z == 0.0f;
        if (p.position.z != 0.0f) ++squares[size_t(p.position.x * 2.0f) + 6 * size_t(p.position.y * 2.0f)];
      }
      EXPECT_NEAR(of_first, run / 4, 1);
      const double each = run / 16.0;
      for (const int n : squares) EXPECT_NEAR(n, each, 0.3 * each + 2.0) << run << " from " << first;
    }
  }
}

TEST(OccluderPoints, FollowTheirTriangles) {
  Scene scene = two_quads();
  OccluderPoints occluders(scene, kCount);
  const auto before = occluders.points();
  for (glm::vec3& p : scene.meshes[1].positions) p += glm::vec3(0.0f, 5.0f, 2.0f);
  occluders.follow(scene);
  for (size_t i = 0; i < before.size(); ++i) {
    const glm::vec3 moved = before[i].position.z == 0.0f ? glm::vec3(0.0f) : glm::vec3(0.0f, 5.0f, 2.0f);
    EXPECT_LT(glm::distance(occluders.points()[i].position, before[i].position + moved), 1e-5f);
  }
  add_quad(scene, 0, {0, 0, 9}, {4, 0, 0}, {0, 1, 0});  // other triangles: other points
  occluders.follow(scene);
  int on_new = 0;
  for (const auto& p : occluders.points()) on_new += p.position.z == 9.0f;
  EXPECT_NEAR(on_new, kCount / 2, 1);
}

TEST(OccluderPoints, WhatPassesHasNoArea) {
  Scene scene = two_quads();
  scene.materials[0].alpha_mode = AlphaMode::blend;
  scene.materials[0].base_color_factor.a = 0.25f;
  int stopping = 0;
  const OccluderPoints occluders(scene, kCount);
  for (const auto& p : occluders.points()) stopping += p.area_m2 > 0.0f;
  EXPECT_NEAR(stopping, kCount / 4, kCount / 100);
}

TEST(OccluderPoints, NoSurfaces) {
  const OccluderPoints occluders(Scene{}, 64);
  for (const auto& p : occluders.points()) EXPECT_EQ(p.area_m2, 0.0f);
}

}  // namespace
}  // namespace volgi::test
