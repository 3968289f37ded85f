// What lit surfaces reflect, in closed form.
#include "core/visibility/light_flux.h"

#include <gtest/gtest.h>
#include <oneapi/tbb/task_arena.h>

#include "tests/support/volume_scenes.h"

namespace volgi::test {
namespace {

glm::dvec3 sum(const std::vector<FluxSample>& samples) {
  glm::dvec3 s(0.0);
  for (const FluxSample& sample : samples) s += glm::dvec3(sample.flux);
  return s;
}

constexpr double kPi = glm::pi<double>();

/// Integral of a spot's falloff over directions [sr]: 2 pi times that of t^2 over the cosine c, t linear in c.
double spot_solid_angle(double inner_deg, double outer_deg) {
  const double inner = std::cos(glm::radians(inner_deg)), outer = std::cos(glm::radians(outer_deg));
  return 2.0 * kPi * ((1.0 - inner) + (inner - outer) / 3.0);
}

TEST(LightFlux, SpotOverATiltedPlane) {
  for (double outer : {35.0, 70.0}) {  // one layer, six layers
    Scene scene;
    add_square(scene, add_material(scene, {0.5f, 0.25f, 0.0f}), glm::vec3(0.0f), {0.1f, 1.0f, 0.05f}, 40.0f);
    scene.lights = {spot_light({0.1f, 1.0f, 0.2f}, {0, -1, 0}, 20.0f, float(outer), {8.0f, 2.0f, 1.0f})};
    const EmbreeScene embree(scene);
    const glm::dvec3 flux = sum(light_flux(embree, 512));
    const double omega = spot_solid_angle(20.0, outer);
    EXPECT_NEAR(flux.x / (0.5 * 8.0 * omega), 1.0, 1e-3) << outer;
    EXPECT_NEAR(flux.y / (0.25 * 2.0 * omega), 1.0, 1e-3) << outer;
    EXPECT_EQ(flux.z, 0.0);
  }
}

TEST(LightFlux, PointLightInABox) {
  Scene scene;
  add_box_inside(scene, add_material(scene, glm::vec3(0.7f)), glm::vec3(0.0f), {1.0f, 0.6f, 2.0f},
                 rotation({1, 2, 3}, 25));
  scene.lights = {point_light({0.3f, -0.2f, 0.1f}, glm::vec3(3.0f))};
  const EmbreeScene embree(scene);
  const std::vector<FluxSample> samples = light_flux(embree, 256);
  EXPECT_NEAR(sum(samples).x / (0.7 * 4.0 * kPi * 3.0), 1.0, 1e-3);
  for (const FluxSample& s : samples) {
    ASSERT_LT(glm::dot(s.normal, s.position - scene.lights[0].position), 0.0f);  // light leaves towards the lamp
  }
}

TEST(LightFlux, SunOnATiltedSquareSeenFromBehind) {
  Scene scene;
  const glm::vec3 normal = glm::normalize(glm::vec3(0.3f, -1.0f, 0.2f));
  add_square(scene, add_material(scene, glm::vec3(0.5f)), glm::vec3(0.0f), normal, 0.7f);
  add_square(scene, add_material(scene, glm::vec3(0.0f)), {0.0f, -3.0f, 0.0f}, {0, 1, 0}, 2.0f);
  scene.lights = {sun_light({0.2f, -1.0f, -0.1f}, glm::vec3(10.0f))};
  const EmbreeScene embree(scene);
  const std::vector<FluxSample> samples = light_flux(embree, 256);
  const double lit = 1.4 * 1.4 * std::abs(double(glm::dot(normal, scene.lights[0].direction)));
  EXPECT_NEAR(sum(samples).x / (0.5 * 10.0 * lit), 1.0, 4.0 / 128.0 / 16.0);
  for (const FluxSample& s : samples) ASSERT_LT(glm::dot(s.normal, normal), -0.99f);
}

TEST(LightFlux, RangeEndsTheLight) {
  Scene scene;
  add_square(scene, add_material(scene, glm::vec3(1.0f)), {0, 0, 0}, {0, 1, 0}, 40.0f);
  scene.lights = {spot_light({0, 1, 0}, {0, -1, 0}, 2.0f, 2.0f, glm::vec3(1.0f))};
  const auto flux = [&](float range_m) {
    scene.lights[0].range_m = range_m;
    return sum(light_flux(EmbreeScene(scene), 64)).x;
  };
  EXPECT_NEAR(flux(2.0f) / flux(0.0f), 1.0 - 1.0 / 16.0, 1e-3);
  EXPECT_EQ(flux(0.9f), 0.0);
}

TEST(LightFlux, BlendStopsItsShareOfRays) {
  Scene scene;
  const int veil = add_material(scene, glm::vec3(1.0f));
  scene.materials[size_t(veil)].alpha_mode = AlphaMode::blend;
  scene.materials[size_t(veil)].base_color_factor.a = 0.3f;
  add_square(scene, veil, {0, 0, 0}, {0, 1, 0}, 40.0f);
  add_square(scene, add_material(scene, glm::vec3(0.5f)), {0, -1, 0}, {0, 1, 0}, 80.0f);
  scene.lights = {spot_light({0, 1, 0}, {0, -1, 0}, 30.0f, 30.0f, glm::vec3(1.0f))};
  const double flux = sum(light_flux(EmbreeScene(scene), 256)).x / spot_solid_angle(30.0, 30.0);
  EXPECT_NEAR(flux, 0.3 + 0.7 * 0.5, 0.005);  // 1 % of the passing share is 4 sigma of 51,000 rays
}

TEST(LightFlux, SameWithAnyNumberOfThreads) {
  Scene scene;
  add_box_inside(scene, add_material(scene, glm::vec3(0.7f)), glm::vec3(0.0f), glm::vec3(1.0f));
  scene.lights = {point_light({0.3f, -0.2f, 0.1f}, glm::vec3(3.0f))};
  const EmbreeScene embree(scene);
  std::vector<FluxSample> found[2];
  for (int threads : {1, 2}) {
    oneapi::tbb::task_arena arena(threads);
    arena.execute([&] { found[threads - 1] = light_flux(embree, 64); });
  }
  ASSERT_EQ(found[0].size(), found[1].size());
  for (size_t i = 0; i < found[0].size(); ++i) {
    ASSERT_EQ(found[0][i].position, found[1][i].position);
    ASSERT_EQ(found[0][i].flux, found[1][i].flux);
  }
}

}  // namespace
}  // namespace volgi::test
