// Light from outside, and surfaces that shine, against closed forms and sums that know no sampling.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>

#include "core/sky.h"
#include "core/surface.h"
#include "reference/path_tracer.h"
#include "reference/scattering.h"
#include "scenes.h"

namespace volgi {
namespace {

using namespace test;
constexpr double kPi = std::numbers::pi;

/// What a pixel sees that looks at `point` from `eye`.
glm::vec3 seen(const Scene& scene, glm::vec3 eye, glm::vec3 point, int spp, std::optional<int> bounces = {}) {
  PathTracerOptions options;
  options.size = {1, 1};
  options.samples_per_pixel = spp;
  options.max_bounces = bounces;
  return path_trace(scene, camera_at(eye, point), options).color.pixels[0];
}

Scene floor_under(std::shared_ptr<const Sky> sky, glm::vec3 albedo) {
  Scene scene;
  add_quad(scene, add_material(scene, albedo), glm::vec3(0), {0, 0, 5}, {5, 0, 0});
  scene.sky = std::move(sky);
  return scene;
}

TEST(SkyLight, OpenPlane) {
  const glm::vec3 radiance(1.0f, 1.1f, 1.3f), albedo(0.8f, 0.5f, 0.2f);
  const Scene scene = floor_under(std::make_shared<Sky>(radiance), albedo);
  const glm::vec3 got = seen(scene, {0.3f, 1.0f, 0.2f}, glm::vec3(0), 64);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(got[c], albedo[c] * radiance[c], 1e-5f);
}

TEST(SkyLight, HalfBehindALongWall) {
  Scene scene = floor_under(std::make_shared<Sky>(glm::vec3(2.0f)), glm::vec3(0.5f));
  add_quad(scene, add_material(scene, glm::vec3(0.0f)), {1.0f, 1.5f, 0.0f}, {0, 0, 3000}, {0, 1.5f, 0});
  // A wall 3 m high, 1 m away, takes (1 - cos) / 2 of the hemisphere's light.
  const double open = 0.5 * (1.0 + 1.0 / std::sqrt(10.0));
  EXPECT_NEAR(seen(scene, {0, 0.5f, 0}, glm::vec3(0), 65536).x, 0.5 * 2.0 * open, 0.005 * open);
}

TEST(SkyLight, ConvexBodyInAFurnace) {
  Scene scene;
  const Mesh& mesh = [&]() -> Mesh& {
    add_sphere_inside(scene, add_material(scene, glm::vec3(0.7f)), 1.0f, 24);
    return scene.meshes.back();
  }();
  ASSERT_FALSE(mesh.triangles.empty());
  scene.sky = std::make_shared<Sky>(glm::vec3(1.5f));
  for (const glm::vec3 eye : {glm::vec3(3, 0, 0), {0.2f, 3, 0.1f}, {-2, -2, 1}})
    EXPECT_NEAR(seen(scene, eye, glm::vec3(0), 256).x, 0.7 * 1.5, 0.005 * 0.7 * 1.5);
}

TEST(SkyLight, SmallBrightSpotIsFoundAndCountedOnce) {
  Image picture(128, 64, glm::vec3(0.1f));
  picture.at(70, 12) = glm::vec3(5000.0f);
  const auto sky = std::make_shared<Sky>(picture, 0.4f);
  const Scene scene = floor_under(sky, glm::vec3(1.0f));
  // Sum of radiance times cosine over a lattice ten times finer than texels.
  double irradiance = 0.0;
  const int rows = 640, columns = 1280;
  for (int y = 0; y < rows / 2; ++y) {
    const double polar = kPi * (y + 0.5) / rows, dw = std::sin(polar) * (kPi / rows) * (2.0 * kPi / columns);
    for (int x = 0; x < columns; ++x) {
      const double turn = 2.0 * kPi * (x + 0.5) / columns;
      const glm::vec3 d(std::sin(polar) * std::sin(turn), std::cos(polar), -std::sin(polar) * std::cos(turn));
      irradiance += double(sky->radiance(d).x) * std::cos(polar) * dw;
    }
  }
  EXPECT_NEAR(seen(scene, {0, 1, 0}, glm::vec3(0), 4096, 0).x, irradiance / kPi, 0.005 * irradiance / kPi);
}

TEST(SkyLight, IsSeenBehindEverything) {
  Scene scene = floor_under(std::make_shared<Sky>(glm::vec3(0.25f, 0.5f, 1.0f)), glm::vec3(0.5f));
  EXPECT_EQ(seen(scene, {0, 1, 0}, {0, 2, -5}, 2, 0), glm::vec3(0.25f, 0.5f, 1.0f));
  PathTracerOptions options;
  options.size = {1, 1};
  options.samples_per_pixel = 2;
  options.light = PathTracerOptions::Light::indirect;
  EXPECT_EQ(path_trace(scene, camera_at({0, 1, 0}, {0, 2, -5}), options).color.pixels[0], glm::vec3(0.0f));
}

// --- matter ---------------------------------------------------------------------------------------------------------

/// Directional albedo of a surface point: a sum over light directions, not over microfacets' normals.
double reflected_of_furnace(const SurfacePoint& surface, double cos_viewer) {
  const Scattering scattering(surface);
  const glm::vec3 normal(0, 0, 1), viewer(float(std::sqrt(1.0 - cos_viewer * cos_viewer)), 0.0f, float(cos_viewer));
  double sum = 0.0;
  constexpr int kRows = 1024, kColumns = 1024;
  for (int i = 0; i < kRows; ++i) {
    const double z = (i + 0.5) / kRows, r = std::sqrt(1.0 - z * z);
    for (int j = 0; j < kColumns; ++j) {
      const double turn = 2.0 * kPi * (j + 0.5) / kColumns;
      sum += double(
          scattering.reflected(normal, viewer, glm::vec3(glm::dvec3(r * std::cos(turn), r * std::sin(turn), z))).x);
    }
  }
  return sum * 2.0 * kPi / (double(kRows) * kColumns);
}

struct Matter {
  float metallic, roughness, specular;
};

TEST(Scattering, FurnaceIsTheSumOverDirections) {
  for (const Matter m : {Matter{1.0f, 0.4f, 0.0f}, {1.0f, 0.9f, 0.0f}, {0.0f, 0.4f, 1.0f}, {0.5f, 0.6f, 1.0f}}) {
    for (const double angle : {0.3, 0.9, 1.3}) {
      Scene scene = floor_under(std::make_shared<Sky>(glm::vec3(1.0f)), glm::vec3(1.0f));
      scene.materials[0].metallic_factor = m.metallic;
      scene.materials[0].roughness_factor = m.roughness;
      scene.materials[0].specular_factor = m.specular;
      const SurfacePoint surface = surface_point(scene, scene.meshes[0], 0, 0.3f, 0.3f);
      const double expected = reflected_of_furnace(surface, std::cos(angle));
      const glm::vec3 eye(float(std::sin(angle)), float(std::cos(angle)), 0.0f);
      EXPECT_NEAR(seen(scene, eye, glm::vec3(0), 16384).x, expected, 0.005 * expected)
          << m.metallic << ' ' << m.roughness << ' ' << angle;
    }
  }
}

// A white metal sphere keeps what every point of it keeps: the furnace.
TEST(Scattering, WhiteMetalSphereInAFurnace) {
  Scene scene;
  add_sphere_inside(scene, add_material(scene, glm::vec3(1.0f)), 1.0f, 64);
  scene.materials[0].metallic_factor = 1.0f;
  scene.materials[0].roughness_factor = 0.4f;
  scene.sky = std::make_shared<Sky>(glm::vec3(1.0f));
  const SurfacePoint surface = surface_point(scene, scene.meshes[0], 100, 0.3f, 0.3f);
  for (const float across : {0.0f, 0.5f, 0.8f}) {
    const glm::vec3 point(std::sqrt(1.0f - across * across), across, 0.0f);
    const double expected = reflected_of_furnace(surface, double(point.x));
    EXPECT_NEAR(seen(scene, point + glm::vec3(4, 0, 0), point, 16384).x, expected, 0.005 * expected) << across;
  }
}

TEST(Scattering, IsReciprocal) {
  SurfacePoint surface{};
  surface.diffuse = glm::vec3(0.5f);
  surface.reflectance_0 = glm::vec3(0.04f);
  surface.reflectance_90 = 1.0f;
  surface.roughness = 0.35f;
  const Scattering scattering(surface);
  const glm::vec3 n(0, 0, 1), a = glm::normalize(glm::vec3(0.3f, 0.1f, 0.8f)),
                              b = glm::normalize(glm::vec3(-0.5f, 0.4f, 0.3f));
  EXPECT_NEAR(scattering.reflected(n, a, b).x / b.z, scattering.reflected(n, b, a).x / a.z, 1e-6f);
}

}  // namespace
}  // namespace volgi
