#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "apps/volgi/volume_options.h"
#include "screen/frame/frame_options.h"
#include "screen/frame/quality.h"

namespace CLI {
class App;
}

namespace volgi::app {

/// What `render` says about the technique: --gi, --light, --backend, --set, the parameters that have an option of their
/// own (--vpls, --vals), --quality, and what VolumeCommandOptions takes. What there is to choose from is the
/// registry's.
struct FrameCommandOptions {
  std::string gi;      // empty: the first recipe that the other options allow; auto: apps/volgi/automatic.h chooses
  std::string budget;  // of auto
  bool explain = false;
  std::string light = "full";
  std::string backend = "auto";
  std::string quality = "default";
  double cells_times = 1.0, lights_times = 1.0;  // those of the quality
  VolumeCommandOptions volume;
  std::map<std::string, std::string> flagged;  // parameters given by an option of their own
  std::vector<std::string> parameters;         // NAME=VALUE
  std::vector<std::string> without;            // stages
  std::optional<SceneFacts> facts;             // of the scene, where fit() need not look again

  void add_to(CLI::App& command);
  /// @throws Error(usage) for a technique, scheme or parameter that does not exist, naming those that do.
  screen::FrameOptions frame_options(glm::ivec2 size) const;
  /// Puts the grid around what matters (VolumeCommandOptions::fit_box), and gives every parameter that nobody has
  /// chosen what --quality asks of the scene. @param eye  of the camera, where it stands still. @param rung  of the
  /// quality truth.
  struct Fitted {
    SceneFacts facts;
    screen::Needs needs;
    std::vector<screen::Chosen> chosen;
  };
  Fitted fit(const Scene& scene, const std::optional<glm::vec3>& eye, int rung, screen::FrameOptions& options) const;
  bool automatic() const { return gi == AUTOMATIC; }
  /// Whether anything was asked for.
  bool given() const;
  /// The technique's name, the default one's too.
  std::string technique() const;

 private:
  static constexpr const char* AUTOMATIC = "auto";
  void check_automatic() const;
  screen::FrameOptions without_recipe(glm::ivec2 size) const;
  void set_parameters(screen::FrameOptions& o) const;
};

}  // namespace volgi::app
