// Light of the sub-lights of virtual lights on what is near them: against an integral over the lit surface.
#include <cmath>
#include <numeric>

#include "screen/frame/registry.h"
#include "screen/lights/resample/virtual_light_subdivision.h"
#include "shaders/shared/near_light.shared.h"
#include "tests/screen/gathered.h"
#include "tests/screen/virtual_light_scenes.h"
#include "tests/support/frame_picture.h"
#include "tests/support/gl_test.h"

namespace volgi::test {
namespace {

using NearLightsTest = GlTest;

constexpr glm::ivec2 kSize{48, 48};
constexpr float kFloorX = 1.5f, kFloorZ = 2.0f;

/// A floor that the sun lights from straight above, and a wall along its edge.
Scene floor_and_wall() {
  Scene scene;
  const int grey = add_material(scene, glm::vec3(0.5f));
  add_quad(scene, grey, {-kFloorX, 0, 0}, {0, 0, kFloorZ}, {2 * kFloorX, 0, 0});
  add_quad(scene, grey, {-kFloorX, 0, 0}, {2 * kFloorX, 0, 0}, {0, 1, 0});
  Light sun;
  sun.type = Light::Type::directional;
  sun.direction = {0, -1, 0};
  sun.intensity = glm::vec3(3.0f);
  scene.lights.push_back(sun);
  update_bounds(scene);
  return scene;
}

Camera at_the_edge(const Scene& scene) {
  return look_at_camera({0.1f, 0.35f, 1.2f}, {0.0f, 0.25f, 0.0f}, 0.7f, scene.bounds_min, scene.bounds_max);
}

/// Irradiance of the wall from the floor, of radiosity 1.
double irradiance_of_wall(glm::dvec3 at) {
  constexpr int kSteps = 300;
  double sum = 0.0;
  // Steps in the angle from the wall's foot, so that the floor near it is seen as finely as it needs.
  const double max_angle = std::atan2(double(kFloorZ), at.y);
  for (int j = 0; j < kSteps; ++j) {
    const double angle = max_angle * (j + 0.5) / kSteps;
    const double z = at.y * std::tan(angle), dz = at.y * max_angle / kSteps / (std::cos(angle) * std::cos(angle));
    for (int i = 0; i < kSteps; ++i) {
      const double x = -double(kFloorX) + 2.0 * double(kFloorX) * (i + 0.5) / kSteps;
      const double squared = (x - at.x) * (x - at.x) + at.y * at.y + z * z;
      sum += z * at.y / (squared * squared) * dz;
    }
  }
  return sum * 2.0 * double(kFloorX) / kSteps / glm::pi<double>();
}

/// Root mean square of the error relative to the integral, on the wall from 2 to 20 cm above the floor.
double rms_error(const gl::Context& context, float near_zone) {
  const Scene scene = floor_and_wall();
  const Camera camera = at_the_edge(scene);
  screen::FrameOptions options;
  screen::apply_recipe("val", options);
  options.light = screen::LightPart::indirect;
  options.size = kSize;
  options.of<screen::VirtualLightOptions>().count = 256;
  options.of<screen::ResampleOptions>().near_zone = near_zone;
  options.of<screen::AreaLightGatherOptions>().interleave = 1;
  const Image image = render(context, scene, camera, options).image;
  const Seen seen(context, scene, camera, kSize);
  double sum = 0.0;
  int checked = 0;
  for (size_t i = 0; i < image.pixels.size(); ++i) {
    const size_t row = i / size_t(kSize.x);  // pictures have their first row at the top, textures at the bottom
    const size_t texel = (size_t(kSize.y) - 1 - row) * size_t(kSize.x) + i % size_t(kSize.x);
    const glm::dvec3 at(seen.position[texel]);
    if (seen.position[texel].w == 0.0f || seen.normal(texel).z < 0.9 || at.y < 0.02 || at.y > 0.2) continue;
    const double expected = 0.5 / glm::pi<double>() * irradiance_of_wall(at) * 0.5 * 3.0;
    const double error = double(image.pixels[i].g) / expected - 1.0;
    sum += error * error;
    ++checked;
  }
  EXPECT_GT(checked, 200);
  return std::sqrt(sum / checked);
}

// Lights are 15 cm apart, their fine sub-lights 4 cm.
TEST_F(NearLightsTest, AWallThatMeetsALitFloor) {
  const double with = rms_error(context(), 4.0f), without = rms_error(context(), 0.0f);
  RecordProperty("with", std::to_string(with));
  RecordProperty("without", std::to_string(without));
  EXPECT_LT(with, 0.05);
  EXPECT_GT(without, 1.8 * with);
}

// Ranges follow on one another, and sub-lights share what their source sends: no flux or area is lost or doubled.
TEST_F(NearLightsTest, SubLightsShareTheFluxOfTheirSource) {
  const Scene scene = floor_and_wall();
  VirtualLightOptions options;
  options.count = 64;
  options.candidates = 16;
  options.along_curve = true;
  Frames frames(context(), scene, options);
  const screen::VirtualLights& candidates = frames.run();
  Seen seen(context(), scene, at_the_edge(scene), kSize);
  screen::ResampleVirtualLights resample(options.candidates);
  resample.run(candidates.list(), seen.gbuffer, seen.timer);
  screen::VirtualLightSubdivision subdivision;
  subdivision.run(frames.maps(), candidates, resample, seen.timer);

  const auto ranges = resample.ranges().download<glm::vec2>(64);
  EXPECT_EQ(ranges.front().x, 0.0f);
  EXPECT_EQ(ranges.back().y, 1024.0f);
  for (size_t i = 1; i < ranges.size(); ++i) EXPECT_EQ(ranges[i].x, ranges[i - 1].y);

  const auto sublights = subdivision.sublights().download<shared::SubLight>(64 * SUBLIGHTS_PER_LIGHT);
  double of_coarse = 0.0, of_fine = 0.0, area_m2 = 0.0;
  for (size_t i = 0; i < sublights.size(); ++i) {
    const bool coarse = i % SUBLIGHTS_PER_LIGHT < COARSE_SUBLIGHTS;
    (coarse ? of_coarse : of_fine) += double(sublights[i].flux.g);
    if (!coarse && sublights[i].flux.g > 0.0f) area_m2 += double(sublights[i].area_m2);
  }
  const double floor_m2 = 2.0 * double(kFloorX) * double(kFloorZ);
  EXPECT_NEAR(of_coarse / of_fine, 1.0, 1e-5);
  EXPECT_NEAR(of_fine / (0.5 * 3.0 * floor_m2), 1.0, 0.02);
  EXPECT_NEAR(area_m2 / floor_m2, 1.0, 0.02);
}

// What a light keeps and what its sub-lights carry add up to one, and neither jumps.
TEST(FarShare, GoesFromNoneToAll) {
  constexpr float kZone = 4.0f, kPi = 3.14159265f;
  const auto share = [&](float squared) { return shared::far_share(squared / (kPi * squared + 1.0f), kZone); };
  EXPECT_EQ(share(0.0f), 0.0f);
  EXPECT_EQ(share(kZone), 0.0f);
  EXPECT_NEAR(share(2.0f * kZone), 1.0f, 1e-5f);
  EXPECT_EQ(share(100.0f), 1.0f);
  for (float s = kZone; s < 2.0f * kZone; s += 0.01f) EXPECT_LT(std::abs(share(s + 0.01f) - share(s)), 0.01f);
  EXPECT_EQ(shared::far_share(0.0f, 0.0f), 1.0f);
}

}  // namespace
}  // namespace volgi::test
