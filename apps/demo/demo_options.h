#pragma once
#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/demo/settings.h"
#include "apps/volgi/device_options.h"
#include "apps/volgi/frame_options.h"
#include "apps/volgi/light_options.h"
#include "apps/volgi/reading_options.h"

namespace volgi::demo {

/// The command line of volgi-demo.
struct DemoOptions {
  std::vector<std::filesystem::path> scenes;  // the first one's frame, others beside it
  std::string size;                           // WxH; empty: 1280x720
  app::FrameCommandOptions frame;
  app::LightOptions light;
  app::ReadingOptions reading;
  app::DeviceOptions device;
  std::string view, exposure, preset;
  std::vector<std::string> commands;  // --do, in their order
  double time_s = 0.0;
  std::filesystem::path settings_file;
  bool no_settings = false;
  std::filesystem::path shaders;
  std::filesystem::path events;  // what happens, a line of JSON each
  std::filesystem::path pictures = ".";
  std::optional<double> quit_after_s;
  std::string list;  // keys, commands or views: printed, and no more

  bool headless = false;
  std::filesystem::path path, benchmark, out;
  int samples = 1;
  int frames = 0;  // of a path; 0: by --fps
  double fps = 25.0;

  void add_to(CLI::App& app);
  glm::ivec2 picture_size() const;
  /// Those of the file, changed as the command line says. @param unknown  lines about what the file has and this
  /// version does not know.
  Settings settings(std::vector<std::string>& unknown) const;
  /// Where --gi is auto: with what it chooses for the first scene, one picture at a time, which it says. Reads the
  /// scene.
  /// @param device_name  gl::Context::device_name().
  Settings with_choice(Settings settings, const std::string& device_name) const;
  std::filesystem::path settings_path() const;
};

}  // namespace volgi::demo
