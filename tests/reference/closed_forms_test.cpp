// Light whose answer is a formula. Tolerances: exact where nothing is sampled, else four standard errors or more.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "reference/path_tracer.h"
#include "scenes.h"

namespace volgi {
namespace {

using namespace test;
constexpr double kPi = std::numbers::pi;

// Radiance that one pixel sees at `point` from straight above (or below, for normal -y).
glm::vec3 radiance_at(const Scene& scene, glm::vec3 point, glm::vec3 normal, int spp, std::optional<int> bounces) {
  PathTracerOptions options;
  options.size = {1, 1};
  options.samples_per_pixel = spp;
  options.max_bounces = bounces;
  return path_trace(scene, camera_at(point + 0.01f * normal, point), options).color.pixels[0];
}

double mean(const Image& image) {
  double sum = 0;
  for (const glm::vec3& p : image.pixels) sum += (p.x + p.y + p.z) / 3.0;
  return sum / static_cast<double>(image.pixels.size());
}

Scene floor_scene(glm::vec3 albedo) {
  Scene scene;
  add_quad(scene, add_material(scene, albedo), glm::vec3(0), {0, 0, 5}, {5, 0, 0});
  return scene;
}

void expect_direct(const Scene& scene, glm::vec3 point, glm::dvec3 irradiance, glm::vec3 albedo,
                   double tolerance = 1e-5) {
  const glm::vec3 got = radiance_at(scene, point, {0, 1, 0}, 2, 0);
  for (int c = 0; c < 3; ++c) {
    const double expected = static_cast<double>(albedo[c]) / kPi * irradiance[c];
    EXPECT_NEAR(got[c], expected, tolerance * expected + 1e-12)
        << "channel " << c << " at " << point.x << "," << point.z;
  }
}

TEST(ClosedForms, PointLightOverAPlane) {
  const glm::vec3 albedo(0.8f, 0.5f, 0.2f), position(0.3f, 2.0f, 0.1f), intensity(3.0f, 2.0f, 1.0f);
  Scene scene = floor_scene(albedo);
  scene.lights = {point_light(position, intensity)};
  for (const glm::vec3 point : {glm::vec3(0.3f, 0, 0.1f), glm::vec3(1, 0, -2), glm::vec3(-4, 0, 4.5f), glm::vec3(0)}) {
    const glm::dvec3 d(position - point);
    expect_direct(scene, point, glm::dvec3(intensity) * d.y / std::pow(glm::length(d), 3), albedo);
  }
}

TEST(ClosedForms, RangeOfAPointLight) {
  Scene scene = floor_scene(glm::vec3(1.0f));
  scene.lights = {point_light({0, 2, 0}, glm::vec3(3.0f))};
  scene.lights[0].range_m = 3.0f;
  expect_direct(scene, glm::vec3(0), glm::dvec3(3.0 / 4 * (1 - std::pow(2.0 / 3, 4))), glm::vec3(1.0f));
  expect_direct(scene, {2.5f, 0, 0}, glm::dvec3(0), glm::vec3(1.0f));
}

TEST(ClosedForms, SpotFalloff) {
  Scene scene = floor_scene(glm::vec3(0.7f));
  Light spot = point_light({0, 2, 0}, glm::vec3(5.0f));
  spot.type = Light::Type::spot;
  spot.direction = {0, -1, 0};
  spot.inner_cone_rad = 0.2f;
  spot.outer_cone_rad = 0.6f;
  scene.lights = {spot};
  for (const float angle : {0.0f, 0.15f, 0.3f, 0.45f, 0.55f, 0.7f}) {
    const double cosine = std::cos(angle), t = (cosine - std::cos(0.6)) / (std::cos(0.2) - std::cos(0.6));
    const double falloff = std::pow(std::clamp(t, 0.0, 1.0), 2);
    expect_direct(scene, {2 * std::tan(angle), 0, 0}, glm::dvec3(5 * falloff * std::pow(cosine, 3) / 4),
                  glm::vec3(0.7f), 1e-4);
  }
}

TEST(ClosedForms, DirectionalLightFromBothSides) {
  Scene scene = floor_scene(glm::vec3(0.6f));
  Light sun = point_light({}, glm::vec3(7.0f));
  sun.type = Light::Type::directional;
  sun.direction = glm::normalize(glm::vec3(1, -2, 0.5f));
  scene.lights = {sun};
  expect_direct(scene, {1, 0, 1}, glm::dvec3(7.0 * -sun.direction.y), glm::vec3(0.6f));
  EXPECT_EQ(radiance_at(scene, {1, 0, 1}, {0, -1, 0}, 2, 0), glm::vec3(0.0f)) << "the plane is between";
  scene.lights[0].direction.y *= -1;
  EXPECT_NEAR(radiance_at(scene, {1, 0, 1}, {0, -1, 0}, 2, 0).x, 0.6 / kPi * 7 * scene.lights[0].direction.y, 1e-5);
}

// Siegel & Howell: from a point to a parallel rectangle x by y whose corner is above the point, x and y over the
// height.
double corner_form_factor(double x, double y) {
  const double sx = std::sqrt(1 + x * x), sy = std::sqrt(1 + y * y);
  return (x / sx * std::atan(y / sx) + y / sy * std::atan(x / sy)) / (2 * kPi);
}

struct EmissiveQuad : testing::Test {
  Scene scene = floor_scene(glm::vec3(0.5f));
  Material& emitter() { return scene.materials[1]; }
  void add(glm::vec3 a, glm::vec3 b) { add_quad(scene, add_material(scene, glm::vec3(0), {2, 4, 8}), {0, 1, 0}, a, b); }
  // Irradiance over radiance at the origin, halves of the picture averaged.
  double seen(int spp = 1 << 16) { return radiance_at(scene, glm::vec3(0), {0, 1, 0}, spp, 0).x / (0.5 / kPi) / 2; }
};

TEST_F(EmissiveQuad, FormFactor) {
  add({0.5f, 0, 0}, {0, 0, 1.5f});
  EXPECT_NEAR(seen(), kPi * 4 * corner_form_factor(0.5, 1.5), 0.003);
}

TEST_F(EmissiveQuad, EmitsFromItsFrontUnlessDoubleSided) {
  add({0, 0, 1.5f}, {0.5f, 0, 0});
  EXPECT_EQ(seen(64), 0.0);
  emitter().double_sided = true;
  EXPECT_NEAR(seen(), kPi * 4 * corner_form_factor(0.5, 1.5), 0.003);
}

TEST_F(EmissiveQuad, TextureIsSampledWithoutBias) {
  add({1, 0, 0}, {0, 0, 1});
  scene.images = {{2, 1, {255, 255, 255, 255, 0, 0, 0, 255}}};  // bright where u < 1/2
  scene.textures = {{0, {}}};
  scene.textures[0].sampler.magnify_nearest = true;
  emitter().emissive.texture = 0;
  EXPECT_NEAR(seen(), kPi * 2 * corner_form_factor(1, 1), 0.003);
}

TEST_F(EmissiveQuad, CoverageScalesEmission) {
  add({0.5f, 0, 0}, {0, 0, 1.5f});
  emitter().alpha_mode = AlphaMode::blend;
  emitter().base_color_factor.w = 0.25f;
  EXPECT_NEAR(seen(), 0.25 * kPi * 4 * corner_form_factor(0.5, 1.5), 0.003);
}

TEST_F(EmissiveQuad, CoverageLetsLightPass) {
  add({0.5f, 0, 0}, {0, 0, 0.5f});
  const int veil = add_material(scene, glm::vec3(0));
  scene.materials[static_cast<size_t>(veil)].alpha_mode = AlphaMode::blend;
  scene.materials[static_cast<size_t>(veil)].base_color_factor.w = 0.3f;
  for (const float height : {0.4f, 0.6f}) add_quad(scene, veil, {0, height, 0}, {3, 0, 0}, {0, 0, 3});
  EXPECT_NEAR(seen(), 0.49 * kPi * 4 * corner_form_factor(0.5, 0.5), 0.01);
  scene.materials[static_cast<size_t>(veil)].alpha_mode = AlphaMode::mask;
  EXPECT_NEAR(seen(), kPi * 4 * corner_form_factor(0.5, 0.5), 0.003) << "0.3 is below the cut-off";
  scene.materials[static_cast<size_t>(veil)].alpha_cutoff = 0.2f;
  EXPECT_EQ(seen(64), 0.0);
}

class Furnace : public testing::TestWithParam<float> {};

TEST_P(Furnace, RadianceIsEmissionOverOneMinusAlbedo) {
  const float albedo = GetParam();
  Scene scene;
  add_box_inside(scene, add_material(scene, glm::vec3(albedo), glm::vec3(1.0f)), {0.2f, 0, 0}, {1, 1.5f, 0.7f});
  PathTracerOptions options;
  options.size = {16, 16};
  options.samples_per_pixel = 256;
  const ReferencePicture picture = path_trace(scene, camera_at({0.3f, 0.2f, 0.1f}, {-1, -1, -0.7f}, 1.2f), options);
  EXPECT_NEAR(mean(picture.color) * (1 - static_cast<double>(albedo)), 1.0, albedo < 0.99f ? 0.004 : 0.02);
  options.max_bounces = 2;  // plus the arrival of emission, which is bounce 0, and emission itself
  const double a = albedo, geometric = 1 + a + a * a + a * a * a;
  EXPECT_NEAR(mean(path_trace(scene, camera_at({0.3f, 0.2f, 0.1f}, {-1, -1, -0.7f}, 1.2f), options).color), geometric,
              0.004 * geometric);
}
INSTANTIATE_TEST_SUITE_P(ClosedForms, Furnace, testing::Values(0.0f, 0.5f, 0.8f, 0.95f, 0.99f));

// A point light in the middle of a sphere: E = I/r², every order is the one before times the albedo.
TEST(ClosedForms, SphericalCavity) {
  Scene scene;
  add_sphere_inside(scene, add_material(scene, glm::vec3(0.8f, 0.5f, 0.2f)), 2.0f, 64);
  scene.lights = {point_light({}, glm::vec3(10.0f))};
  PathTracerOptions options;
  options.size = {24, 24};
  options.samples_per_pixel = 256;
  options.filter = PathTracerOptions::Filter::box;
  const ReferencePicture all = path_trace(scene, camera_at({0.3f, 0.1f, 0.2f}, {1, -0.4f, -2}, 1.5f), options);
  options.max_bounces = 1;
  const ReferencePicture one = path_trace(scene, camera_at({0.3f, 0.1f, 0.2f}, {1, -0.4f, -2}, 1.5f), options);
  glm::dvec3 sum_all(0.0), sum_one(0.0);
  for (size_t i = 0; i < all.color.pixels.size(); ++i) {
    sum_all += glm::dvec3(all.color.pixels[i]) / 576.0;
    sum_one += glm::dvec3(one.color.pixels[i]) / 576.0;
  }
  const glm::dvec3 albedo(0.8, 0.5, 0.2);
  for (int c = 0; c < 3; ++c) {
    const double first = albedo[c] / kPi * 10 / 4;
    EXPECT_NEAR(sum_all[c] * (1 - albedo[c]) / first, 1.0, 0.006) << c;  // 64 rings are 0.1 % smaller than the sphere
    EXPECT_NEAR(sum_one[c] / (1 + albedo[c]) / first, 1.0, 0.006) << c;
  }
}

// All light of an emitter in the ceiling is absorbed by the walls, nothing more and nothing less.
TEST(ClosedForms, ClosedBoxKeepsItsPower) {
  constexpr float albedo = 0.7f;
  Scene scene;
  add_box_inside(scene, add_material(scene, glm::vec3(albedo)), {}, glm::vec3(1.0f));
  add_quad(scene, add_material(scene, glm::vec3(0), glm::vec3(3.0f)), {0, 0.9999f, 0}, {0.25f, 0, 0}, {0, 0, 0.25f});
  PathTracerOptions options;
  options.size = {24, 24};
  options.samples_per_pixel = 256;
  options.filter = PathTracerOptions::Filter::box;
  double absorbed = 0;
  for (int axis = 0; axis < 3; ++axis)
    for (const float side : {-1.0f, 1.0f}) {
      glm::vec3 wall(0.0f);
      wall[axis] = side;
      const Image color = path_trace(scene, camera_at(0.99f * -wall, wall, 0.5f, 1.0f), options).color;
      const double emission = axis == 1 && side > 0 ? 3.0 * 0.25 : 0.0;  // seen directly, [W/m²/sr · m²]
      absorbed += (mean(color) * 4.0 - emission) * kPi / albedo * (1 - albedo);
    }
  // The emitter's own black face absorbs what it receives: about the ceiling's irradiance on 0.25 m².
  const Image near = path_trace(scene, camera_at({0, 0.9f, 0}, {0, 1, 0}, 0.5f, 0.5f), options).color;
  const double ring = (mean(near) - 3.0 * 0.25) / 0.75 * kPi / albedo * 0.25;
  EXPECT_NEAR((absorbed + ring) / (kPi * 3.0 * 0.25), 1.0, 0.01);
}

}  // namespace
}  // namespace volgi
