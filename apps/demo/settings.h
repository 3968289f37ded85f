#pragma once
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "apps/demo/camera_pose.h"
#include "screen/frame/frame_options.h"

namespace volgi::demo {

/// A named camera of a scene.
struct Bookmark {
  std::string name;  // once in a scene
  CameraPose pose;
};

/// 0: none.
struct FpsLimits {
  int active = 0;
  int in_background = 10;  // the window has not the focus
};

struct BenchmarkDefaults {
  int warm_up_frames = 10;
  int frames = 100;
  int width = 1280, height = 720;
};

/// What the window remembers from one run to the next.
struct Settings {
  /// Recipe, backend, light, bounces, and the options of techniques and of the volume; its size is not kept.
  screen::FrameOptions frame;
  /// Cells by the scene (automatic_grid_cells()), not those of frame.of<VolumeOptions>().
  bool grid_fits_scene = true;

  std::string view = "picture";
  std::optional<double> exposure_ev;  // stops; none: automatic
  bool post_filter = true;            // while something moves
  bool progressive = true;            // averages jittered pictures while nothing moves
  int most_samples = 64;              // of it
  double motion_fps = 12.0;           // quality gives way for it while something moves (motion.h); 0: never
  bool reference = false;             // path traces in the background
  FpsLimits fps;
  BenchmarkDefaults benchmark;

  std::map<std::string, bool> panels;                      // by name, whatever panels there are: open or not
  std::map<std::string, std::vector<Bookmark>> bookmarks;  // by the scene's path
  std::vector<std::filesystem::path> recent_files;         // the latest first, without twins, MOST_RECENT_FILES at most

  /// The text of the file that they were read from: what of it this version does not know is written back.
  std::string as_read;

  static constexpr size_t MOST_RECENT_FILES = 10;
  static constexpr int MOST_SAMPLES = 1'000'000;
};

/// Puts a file first among the recent ones.
void add_recent_file(Settings& settings, const std::filesystem::path& file);

struct ReadSettings {
  Settings settings;
  std::vector<std::string> unknown;  // a line for each member that this version does not know, naming file and place
};

/// {"volgi_demo": 1, ...}; what the file does not say has its default, and everything has where there is no such file.
/// Parameters of techniques are members of "technique.parameters", by name, with the text that --set takes.
/// @throws Error(bad_input) naming file and place: not JSON, another type, a value out of range, a recipe, scheme or
/// view of light that does not exist, a newer version.
ReadSettings read_settings(const std::filesystem::path& file);

/// Atomically; makes the folders that are missing. Parameters are written where they are not the recipe's own. Members
/// that read_settings() did not know stay where they were. The same settings make the same bytes.
/// @throws Error(cannot_write).
void write_settings(const std::filesystem::path& file, const Settings& settings);

/// $XDG_CONFIG_HOME/volgi/demo.json, or ~/.config/volgi/demo.json; empty where the environment names neither.
std::filesystem::path default_settings_path();

}  // namespace volgi::demo
