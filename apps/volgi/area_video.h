#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "core/scene.h"

namespace CLI {
class App;
}

namespace volgi::app {

/// --area-video, --area-fps: pictures that play on a scene's emissive textures, over and over.
class AreaVideo {
 public:
  void add_to(CLI::App& command);
  /// Puts the picture of this time in place of every emissive texture's. Nothing where there is no --area-video.
  /// @return whether it is another one than before: then what has been made for the scene's images is to be made anew.
  /// @throws Error(usage) when no emissive surface has a texture, or there is no such file; Error(bad_input) naming a
  /// file that is no PNG.
  bool show(Scene& scene, double time_s);
  /// The next show() is of a scene whose images are its own.
  void forget_shown() { shown_ = SIZE_MAX; }
  bool plays() const { return !files_.empty(); }
  /// Of all pictures; 0 where there is no --area-video. @throws Error(usage) as show().
  double duration_s();
  /// As a command line has them; none where there is no --area-video.
  std::vector<std::string> arguments() const;

 private:
  std::vector<std::filesystem::path> list_files() const;

  std::string files_;  // a folder, or a name with %d or %0Nd
  double frames_per_s_ = 24.0;
  std::vector<std::filesystem::path> list_;
  size_t shown_ = SIZE_MAX;
};

}  // namespace volgi::app
