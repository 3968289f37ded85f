#pragma once
#include <filesystem>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/volgi/light_options.h"
#include "apps/volgi/reading_options.h"
#include "core/camera.h"
#include "core/scene.h"

namespace CLI {
class App;
}

namespace volgi::app {

/// Help on SCENE (core/scene_source.h).
inline constexpr const char* scene_help = "glTF 2.0 scene (.gltf or .glb), or builtin:metaballs";

/// What every command that looks at a scene takes: SCENE, --time, --camera N | --eye, --target, --yfov, --size WxH,
/// ReadingOptions and LightOptions.
struct SceneOptions {
  std::filesystem::path scene_path;
  ReadingOptions file;
  double time_s = 0.0;
  std::optional<int> camera_index;
  std::vector<double> eye, target;  // 3 numbers each, file's world frame
  double yfov_deg = 40.0;
  std::string size_text = "512x512";
  LightOptions light;
  bool no_default_light = false;
  mutable std::optional<Camera> made_camera;       // where the file has none
  mutable std::shared_ptr<const Sky> default_sky;  // where nothing shines

  void add_to(CLI::App& command);
  /// @throws Error(usage) when the text is not WxH with both in 1 ... 16384.
  glm::ivec2 size() const;
  /// The requested camera; the file's first one; or, with a warning, one inside a closed place (room_camera) or one
  /// that frames the bounds, the same one for all frames.
  /// @throws Error(usage) for a camera that does not exist, naming how many there are.
  Camera camera(const Scene& scene) const;
  /// A soft sky, and a lamp above and beside the camera, where nothing shines and --no-default-light is not given, said
  /// in one line: for pictures to look at, not for measurements.
  void add_default_lamp(Scene& scene, const Camera& camera) const;
};

}  // namespace volgi::app
