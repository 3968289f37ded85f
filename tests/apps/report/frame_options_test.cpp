#include "apps/volgi/frame_options.h"

#include <gtest/gtest.h>

#include <algorithm>

#include <CLI/CLI.hpp>

#include "screen/frame/registry.h"

namespace volgi::app {
namespace {

std::string value_of(const char* name, std::vector<std::string> arguments) {
  CLI::App app;
  FrameCommandOptions options;
  options.add_to(app);
  std::reverse(arguments.begin(), arguments.end());
  app.parse(arguments);
  return screen::value_text(screen::find_parameter(name), options.frame_options(glm::ivec2(64)).settings);
}

TEST(FrameCommandOptions, WhatIsAskedForGoesOverWhatTheRecipePrefers) {
  EXPECT_EQ(value_of("gather", {}), "multires");
  EXPECT_EQ(value_of("gather", {"--gi", "val"}), "interleaved");
  EXPECT_EQ(value_of("gather", {"--gi", "val", "--set", "gather=multires"}), "multires");
  EXPECT_EQ(value_of("visibility", {"--gi", "lattice"}), "imperfect");
  EXPECT_EQ(value_of("visibility", {"--gi", "lattice", "--set", "visibility=none"}), "none");
  EXPECT_EQ(value_of("vpl.count", {"--gi", "val", "--vpls", "77"}), "77");
}

}  // namespace
}  // namespace volgi::app
