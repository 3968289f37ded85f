#include "apps/demo/camera_arguments.h"

#include <gtest/gtest.h>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <random>
#include <sstream>

#include "apps/demo/camera_control.h"
#include "apps/demo/camera_pose.h"
#include "apps/volgi/scene_options.h"

namespace volgi::demo {
namespace {

Scene scene_at(glm::dvec3 origin, float half_size) {
  Scene scene;
  scene.world_origin = origin;
  scene.bounds_min = glm::vec3(-half_size);
  scene.bounds_max = half_size * glm::vec3(1.0f, 0.5f, 2.0f);
  return scene;
}

/// What `volgi render` makes of the arguments.
Camera as_rendered(const std::string& arguments, const Scene& scene) {
  std::istringstream stream("scene.glb " + arguments);
  std::vector<std::string> words{std::istream_iterator<std::string>(stream), {}};
  std::reverse(words.begin(), words.end());
  CLI::App app;
  app::SceneOptions options;
  options.add_to(app);
  app.parse(words);
  return options.camera(scene);
}

double largest_difference(const Camera& a, const Camera& b) {
  double worst = std::abs(a.yfov_rad - b.yfov_rad);
  for (int column = 0; column < 3; ++column)
    worst = std::max(worst, double(glm::distance(a.world_from_camera[column], b.world_from_camera[column])));
  const glm::vec3 eye_a(a.world_from_camera[3]), eye_b(b.world_from_camera[3]);
  return std::max(worst, double(glm::distance(eye_a, eye_b)) / std::max(1.0, double(glm::length(eye_a))));
}

TEST(CameraArguments, RenderMakesTheSameCamera) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> unit(-1.0f, 1.0f);
  for (const glm::dvec3 origin : {glm::dvec3(0.0), glm::dvec3(512345.25, -31.7, 4321987.125)}) {
    for (const float size : {0.01f, 3.0f, 5000.0f}) {
      const Scene scene = scene_at(origin, size);
      for (int i = 0; i < 50; ++i) {
        Camera camera;
        camera.yfov_rad = 0.1f + 1.4f * std::abs(unit(random));
        camera.world_from_camera[3] = glm::vec4(size * glm::vec3(unit(random), unit(random), unit(random)), 1.0f);
        camera = with_angles(camera, {3.1 * double(unit(random)), STEEPEST_RAD * double(unit(random)), 0.0});
        camera = with_depth_of(camera, scene.bounds_min, scene.bounds_max);
        ASSERT_TRUE(as_arguments_exact(camera));
        const std::string text = camera_arguments(camera, scene);
        const Camera again = as_rendered(text, scene);
        EXPECT_LT(largest_difference(camera, again), 1e-6) << text;
        EXPECT_EQ(again.yfov_rad, camera.yfov_rad) << text;
        // A double's rounding at 4e6 m.
        EXPECT_LT(glm::distance(again.world_from_camera[3], camera.world_from_camera[3]), 1e-9f) << text;
        EXPECT_FLOAT_EQ(again.znear, camera.znear) << text;
        EXPECT_FLOAT_EQ(again.zfar, camera.zfar) << text;
      }
    }
  }
}

TEST(CameraArguments, NumbersAreAsShortAsTheyCanBe) {
  const Scene scene = scene_at(glm::dvec3(0.0), 2.0f);
  const Camera camera =
      look_at_camera({1.2f, 0.3f, 5}, {1.2f, 0.3f, 0}, glm::radians(40.0f), scene.bounds_min, scene.bounds_max);
  const std::string text = camera_arguments(camera, scene);
  EXPECT_EQ(text.substr(0, text.find(" --target")), "--eye 1.2,0.3,5");
  EXPECT_EQ(text.substr(text.find("--yfov")), "--yfov 40");
}

TEST(CameraArguments, SayWhatTheyCannot) {
  const Camera plain = look_at_camera({3, 2, 6}, {0, 0, 0}, 0.8f, glm::vec3(-1), glm::vec3(1));
  EXPECT_TRUE(as_arguments_exact(plain));
  EXPECT_TRUE(as_arguments_exact(look_at_camera({0, 2, 0}, {0, 0, 0}, 0.8f, glm::vec3(-1), glm::vec3(1))));
  Camera flat = plain;
  flat.kind = Camera::Kind::orthographic;
  EXPECT_FALSE(as_arguments_exact(flat));
  ViewAngles leaning = view_angles(plain);
  leaning.roll_rad = 1e-3;
  EXPECT_FALSE(as_arguments_exact(with_angles(plain, leaning)));
  Camera wide = plain;
  wide.yfov_rad = glm::radians(179.5f);
  EXPECT_FALSE(as_arguments_exact(wide));
}

TEST(CameraPose, GoesThroughAnySceneFrame) {
  const Scene here = scene_at({1e5, 20, -3e4}, 4.0f), there = scene_at({1e5 + 1, 21, -3e4 + 2}, 4.0f);
  Camera camera = look_at_camera({3, 2, 6}, {0, 0, 0}, 0.8f, here.bounds_min, here.bounds_max);
  EXPECT_LT(largest_difference(camera_of(pose_of(camera, here), here), camera), 1e-6);
  const Camera moved = camera_of(pose_of(camera, here), there);
  EXPECT_LT(glm::distance(glm::vec3(moved.world_from_camera[3]), glm::vec3(2, 1, 4)), 1e-6f);
  camera.kind = Camera::Kind::orthographic;
  camera.ymag = 3.5f;
  const Camera flat = camera_of(pose_of(camera, here), here);
  EXPECT_EQ(flat.kind, Camera::Kind::orthographic);
  EXPECT_EQ(flat.ymag, 3.5f);
}

}  // namespace
}  // namespace volgi::demo
