#pragma once
#include <string>
#include <vector>

#include "apps/volgi/volume_options.h"
#include "screen/frame/frame.h"

namespace CLI {
class App;
}

namespace volgi::app {

/// What `render` says about the technique: --gi, --light, --backend, --vpls, --vpls-per-light, --set
/// and what VolumeCommandOptions takes.
struct FrameCommandOptions {
  std::string gi;  // empty: hybrid, or volume with a scheme that only the volume can take
  std::string light = "full";
  std::string backend = "auto";
  VolumeCommandOptions volume;
  int vpls = 1024;
  int vals = 64;
  std::optional<int> vpls_per_light;
  std::vector<std::string> parameters;  // NAME=VALUE

  void add_to(CLI::App& command);
  /// @throws Error(usage) for a technique, scheme or parameter that does not exist, naming those that do.
  screen::FrameOptions frame_options(glm::ivec2 size) const;
  /// The technique's name, the default one's too.
  std::string technique() const;
};

}  // namespace volgi::app
