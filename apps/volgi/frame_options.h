#pragma once
#include <CLI/CLI.hpp>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "screen/frame.h"

namespace volgi::app {

/// What `render` and `bench` say about the technique: --gi, --light, --bounces, --grid, --scheme, --iterations, --set.
struct FrameCommandOptions {
  std::string gi = "volume";
  std::string light = "full";
  std::string scheme = "ordinates";
  std::optional<int> bounces, iterations, directions;
  int grid_cells = 32;
  std::vector<std::string> parameters;  // NAME=VALUE

  void add_to(CLI::App& command);
  /// @throws Error(usage) for a technique, scheme or parameter that does not exist, naming those that do.
  screen::FrameOptions frame_options(glm::ivec2 size) const;
};

}  // namespace volgi::app
