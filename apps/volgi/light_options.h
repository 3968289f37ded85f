#pragma once
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/volgi/area_video.h"
#include "core/scene.h"

namespace CLI {
class App;
}

namespace volgi::app {

/// Comma-separated; none for what is not.
std::vector<double> parse_numbers(std::string_view text);

/// What light and matter a command adds to a scene's own: --lamp, --sun, --sky, --sky-rotate, --lamp-scale,
/// --materials, --lights.
struct LightOptions {
  std::vector<std::string> lamps, suns;
  std::string sky;
  double sky_rotate_deg = 0.0;
  double lamp_scale = 1.0;
  std::string materials = "gltf";
  AreaVideo video;               // whoever plays it adds its options and shows it
  std::filesystem::path lights;  // core/light_file.h; empty: those of the scene

  /// --sky and --sky-rotate in place of those that there are.
  void set_sky(const std::string& text, double rotate_deg);
  void add_to(CLI::App& command);
  /// As a command line has them, a space before each: " --sky 1,1,1"; empty where nothing is asked for.
  std::string arguments() const;
  /// Once after every SceneSource::at() or move().
  /// @throws Error(usage) naming the text that says nothing, Error(bad_input) as read_sky().
  void apply(Scene& scene) const;

  /// --materials phong:N: N, and -1 for phong alone; none for what is neither.
  static std::optional<double> phong_of(const std::string& materials);

 private:
  void put_sky(Scene& scene) const;
  mutable std::shared_ptr<const Sky> made_sky_;  // read or made once
};

}  // namespace volgi::app
