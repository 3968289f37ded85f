#pragma once
#include <map>
#include <string>
#include <vector>

#include "apps/volgi/volume_options.h"
#include "screen/frame/frame_options.h"

namespace CLI {
class App;
}

namespace volgi::app {

/// What `render` says about the technique: --gi, --light, --backend, --set, the parameters that have an option of their
/// own (--vpls, --vals), and what VolumeCommandOptions takes. What there is to choose from is the registry's.
struct FrameCommandOptions {
  std::string gi;  // empty: the first recipe that the other options allow
  std::string light = "full";
  std::string backend = "auto";
  VolumeCommandOptions volume;
  std::map<std::string, std::string> flagged;  // parameters given by an option of their own
  std::vector<std::string> parameters;         // NAME=VALUE
  std::vector<std::string> without;            // stages

  void add_to(CLI::App& command);
  /// @throws Error(usage) for a technique, scheme or parameter that does not exist, naming those that do.
  screen::FrameOptions frame_options(glm::ivec2 size) const;
  /// Whether anything was asked for.
  bool given() const;
  /// The technique's name, the default one's too.
  std::string technique() const;

 private:
  screen::FrameOptions without_recipe(glm::ivec2 size) const;
  void set_parameters(screen::FrameOptions& o) const;
};

}  // namespace volgi::app
