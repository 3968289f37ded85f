// Nested grids on the command line.
#include "apps/volgi/volume_options.h"

#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <functional>

#include "core/error.h"
#include "tests/support/volume_scenes.h"

namespace volgi::app {
namespace {

VolumeCommandOptions parse(std::vector<std::string> arguments) {
  CLI::App app;
  VolumeCommandOptions options;
  options.add_to(app);
  options.add_cascades_to(app);
  std::reverse(arguments.begin(), arguments.end());
  app.parse(arguments);
  return options;
}

ExitCode code_of(const std::function<void()>& what) {
  try {
    what();
  } catch (const Error& e) {
    return e.code();
  }
  return ExitCode::done;
}

Scene hall() {
  Scene scene;
  test::add_box_inside(scene, test::add_material(scene, glm::vec3(0.5f)), glm::vec3(0.0f), glm::vec3(10.0f));
  scene.world_origin = {100.0, 0.0, 0.0};
  return scene;
}

TEST(CascadeOptions, AreOneGridUnlessAskedFor) {
  EXPECT_FALSE(parse({}).volume_options().cascade.nested());
  EXPECT_FALSE(parse({}).given());
  EXPECT_TRUE(parse({"--cascades", "3"}).given());
}

TEST(CascadeOptions, LieAroundTheCamera) {
  const VolumeCommandOptions command = parse({"--cascades", "3", "--cascade-ratio", "4"});
  VolumeOptions options = command.volume_options();
  EXPECT_EQ(options.cascade.levels, 3);
  EXPECT_EQ(options.cascade.ratio, 4);
  command.fit_box(hall(), glm::vec3(1.0f, 2.0f, 3.0f), options);
  EXPECT_EQ(options.cascade.around, glm::vec3(1.0f, 2.0f, 3.0f));
}

TEST(CascadeOptions, LieInBoxesOfTheFilesFrame) {
  const VolumeCommandOptions command = parse({"--cascade", "95,-5,-5,105,5,5", "--cascade", "101,1,1,99,-1,-1.5"});
  VolumeOptions options = command.volume_options();
  ASSERT_EQ(options.cascade.levels, 3);
  command.fit_box(hall(), {}, options);
  EXPECT_EQ(options.cascade.boxes[0].min, glm::vec3(-5.0f));
  EXPECT_EQ(options.cascade.boxes[1].min, glm::vec3(-1.0f, -1.0f, -1.5f));
  EXPECT_EQ(options.cascade.boxes[1].max, glm::vec3(1.0f));
  options.grid_cells = 64;
  EXPECT_EQ(make_cascade(make_grid(hall(), 64), options.cascade).levels(), 3u);
}

TEST(CascadeOptions, WhatMakesNoSenseIsWrongUsage) {
  EXPECT_THROW(parse({"--cascades", "3", "--cascade", "0,0,0,1,1,1"}), CLI::ParseError);
  EXPECT_THROW(parse({"--cascades", "3", "--cascade-ratio", "3"}), CLI::ParseError);
  EXPECT_THROW(parse({"--cascades", "0"}), CLI::ParseError);
  EXPECT_EQ(code_of([] { parse({"--cascades", "3", "--scheme", "conservative"}).volume_options(); }), ExitCode::usage);
  for (const char* text : {"0,0,0,1,1", "0,0,0,1,1,1,", "0,0,0,1,1,x", "0,0,0,1,1,1,1"}) {
    const VolumeCommandOptions command = parse({"--cascade", text});
    VolumeOptions options = command.volume_options();
    EXPECT_EQ(code_of([&] { command.fit_box(hall(), {}, options); }), ExitCode::usage) << text;
  }
}

}  // namespace
}  // namespace volgi::app
