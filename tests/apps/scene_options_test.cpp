#include <gtest/gtest.h>

#include <CLI/CLI.hpp>

#include "apps/volgi/scene_options.h"
#include "core/error.h"

namespace volgi::app {
namespace {

SceneOptions parse(std::vector<std::string> arguments) {
  CLI::App app;
  SceneOptions options;
  options.add_to(app);
  std::reverse(arguments.begin(), arguments.end());
  app.parse(arguments);
  return options;
}

Scene scene_with(size_t cameras) {
  Scene scene;
  scene.path = "some.glb";
  scene.bounds_min = glm::vec3(-1);
  scene.bounds_max = glm::vec3(1);
  for (size_t i = 0; i < cameras; ++i) scene.cameras.emplace_back().name = std::to_string(i);
  return scene;
}

TEST(SceneOptions, DefaultsAndAllOptions) {
  const SceneOptions plain = parse({"a.glb"});
  EXPECT_EQ(plain.scene_path, "a.glb");
  EXPECT_EQ(plain.time_s, 0.0);
  EXPECT_EQ(plain.size(), glm::ivec2(512, 512));
  const SceneOptions all = parse(
      {"a.glb", "--time", "2.5", "--eye", "-1,2e3,-3.5", "--target", "0,0,0", "--yfov", "60", "--size", "640x480"});
  EXPECT_EQ(all.time_s, 2.5);
  EXPECT_EQ(all.eye, (std::vector<double>{-1, 2000, -3.5}));
  EXPECT_EQ(all.target, (std::vector<double>{0, 0, 0}));
  EXPECT_EQ(all.size(), glm::ivec2(640, 480));
}

TEST(SceneOptions, WrongUsageIsRefused) {
  const std::vector<std::vector<std::string>> wrong = {
      {},
      {"a.glb", "--eye", "1,2,3"},
      {"a.glb", "--target", "1,2,3"},
      {"a.glb", "--eye", "1,2", "--target", "1,2,3"},
      {"a.glb", "--eye", "1,2,3,4", "--target", "1,2,3"},
      {"a.glb", "--eye", "1,2,x", "--target", "1,2,3"},
      {"a.glb", "--eye", "1,2,nan", "--target", "1,2,3"},
      {"a.glb", "--eye", "1,2,3", "--target", "0,0,0", "--camera", "0"},
      {"a.glb", "--camera", "-1"},
      {"a.glb", "--camera", "one"},
      {"a.glb", "--time", "inf"},
      {"a.glb", "--yfov", "60"},
      {"a.glb", "--eye", "1,2,3", "--target", "0,0,0", "--yfov", "180"},
  };
  for (const auto& arguments : wrong)
    EXPECT_THROW(parse(arguments), CLI::ParseError) << ::testing::PrintToString(arguments);
}

TEST(SceneOptions, SizesOutOfRange) {
  for (const char* text :
       {"", "512", "x", "0x10", "10x0", "-1x5", "16385x1", "10x10x10", "1e2x5", "99999999999x1", " 5x5"}) {
    SceneOptions options;
    options.size_text = text;
    try {
      options.size();
      FAIL() << text;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::usage);
    }
  }
}

TEST(SceneOptions, CameraOfTheFile) {
  const Scene scene = scene_with(2);
  EXPECT_EQ(parse({"a"}).camera(scene).name, "0");
  EXPECT_EQ(parse({"a", "--camera", "1"}).camera(scene).name, "1");
  try {
    parse({"a", "--camera", "2"}).camera(scene);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::usage);
    EXPECT_NE(std::string(error.what()).find("2 camera"), std::string::npos);
  }
}

TEST(SceneOptions, EyeIsInTheFilesFrame) {
  Scene scene = scene_with(1);
  scene.world_origin = {1e7, 0, 0};
  const Camera camera = parse({"a", "--eye", "10000000.25,0,4", "--target", "10000000.25,0,0"}).camera(scene);
  EXPECT_EQ(glm::vec3(camera.world_from_camera[3]), glm::vec3(0.25f, 0, 4));
  EXPECT_NEAR(camera.yfov_rad, 40.0f * 0.0174532925f, 1e-6f);
  EXPECT_THROW(parse({"a", "--eye", "1,2,3", "--target", "1,2,3"}).camera(scene), Error);
}

TEST(SceneOptions, WithoutACameraTheBoundsAreFramed) {
  ::testing::internal::CaptureStderr();
  EXPECT_EQ(parse({"a"}).camera(scene_with(0)).name, "framing");
  EXPECT_NE(::testing::internal::GetCapturedStderr().find("no camera"), std::string::npos);
}

}  // namespace
}  // namespace volgi::app
