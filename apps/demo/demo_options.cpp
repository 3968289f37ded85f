#include "apps/demo/demo_options.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "apps/demo/presets.h"
#include "apps/demo/view.h"
#include "apps/volgi/automatic.h"
#include "apps/volgi/parse_number.h"
#include "apps/volgi/scene_options.h"
#include "core/error.h"
#include "core/scene_source.h"

namespace volgi::demo {

namespace {
constexpr const char* DEFAULT_SIZE = "1280x720";
constexpr int LARGEST_EDGE = 16384;
}  // namespace

void DemoOptions::add_to(CLI::App& app) {
  app.add_option(
         "SCENE", scenes,
         "glTF 2.0 scene (.gltf or .glb), or builtin:metaballs; more: beside it (the Cornell box); or one OpenVDB "
         "file (.vdb) to look at")
      ->type_name("FILE");
  app.add_option("--size", size, fmt::format("of the window, or of the picture without one ({})", DEFAULT_SIZE))
      ->type_name("WxH");
  app.add_option("--time", time_s, "of the scene's animations [s]")->capture_default_str();
  app.add_option("--view", view, "what is shown first");
  app.add_option("--exposure", exposure, "stops, or auto")->type_name("EV|auto");
  app.add_option("--preset", preset, "fast, default or fine");
  app.add_option("--do", commands, "a command of the window once the scene is there (F1 lists them); may be repeated")
      ->type_name("COMMAND");
  frame.add_to(app);
  light.add_to(app);
  light.video.add_to(app);
  reading.add_to(app);
  device.add_to(app);
  app.add_option("--settings", settings_file, "file of settings ($XDG_CONFIG_HOME/volgi/demo.json)");
  app.add_flag("--no-settings", no_settings, "neither reads nor writes settings");
  app.add_option("--shaders", shaders, "folder of shaders, read anew whenever one of them changes");
  app.add_option("--pictures", pictures, "folder for screenshots")->capture_default_str();
  app.add_option("--events", events, "writes what happens to this file, a line of JSON each");
  app.add_option(
      "--list", list,
      "prints the window's keys, commands or views, or for a volume volume-keys or volume-commands, as a Markdown "
      "table, and ends");
  app.add_option("--quit-after", quit_after_s, "ends after so long [s]");
  CLI::Option* no_window = app.add_flag("--headless", headless, "renders to -o without a window or a display");
  CLI::Option* along =
      app.add_option("--path", path, "a camera's path, as `path save` writes it: a picture for each frame of it");
  CLI::Option* bench =
      app.add_option("--benchmark", benchmark,
                     "plays a camera's path at a fixed step and writes times, pictures and settings to the folder -o");
  bench->excludes(along);
  app.add_option(
      "-o,--output", out,
      "picture (.png, .exr); with --path a name with %04d, or a film (.mp4, .webm, .webp, .gif) through ffmpeg");
  app.add_option("--samples", samples, "pictures that are averaged into each")
      ->check(CLI::Range(1, 65536))
      ->capture_default_str();
  app.add_option("--frames", frames, "of a path (as --fps makes them)")->check(CLI::Range(1, 100000));
  app.add_option("--fps", fps, "frames a second of a path")->check(CLI::Range(0.1, 1000.0))->capture_default_str();
  along->needs(no_window);
  app.footer(
      "Examples: volgi-demo data/room.glb\n"
      "          volgi-demo data/cornell.glb --headless --view voxels -o voxels.png\n"
      "          volgi-demo builtin:metaballs --headless --path tour.json -o tour.webp\n"
      "          volgi-demo out/cornell.vdb --headless --do \"grid radiance\" --do \"direction 0,-90\" -o down.png\n"
      "Exit codes: as volgi's; 4 without a display or OpenGL 4.5.");
}

glm::ivec2 DemoOptions::picture_size() const {
  const std::string text = size.empty() ? DEFAULT_SIZE : size;
  const size_t x = text.find('x');
  const auto width = app::parse_number<int>(std::string_view(text).substr(0, x));
  const auto height =
      x == std::string::npos ? std::nullopt : app::parse_number<int>(std::string_view(text).substr(x + 1));
  const auto fits = [](std::optional<int> edge) { return edge && *edge >= 1 && *edge <= LARGEST_EDGE; };
  if (!fits(width) || !fits(height))
    throw Error(ExitCode::usage, fmt::format("--size '{}': give WxH, such as {}", text, DEFAULT_SIZE));
  return {*width, *height};
}

std::filesystem::path DemoOptions::settings_path() const {
  if (no_settings) return {};
  return settings_file.empty() ? default_settings_path() : settings_file;
}

Settings DemoOptions::with_choice(Settings settings, const std::string& device_name) const {
  if (!frame.automatic()) return settings;
  app::SceneOptions first;
  first.scene_path = scenes.front();
  Scene scene = SceneSource(first.scene_path, reading.reading).at(time_s);
  light.apply(scene);
  const Camera camera = first.camera(scene);
  const auto automatic = app::choose_automatically(frame, scene, camera, picture_size(), device_name, true);
  fmt::print("{}{}", automatic->summary(), frame.explain ? automatic->rejected() : "");
  std::fflush(stdout);
  settings.frame = automatic->frame.frame_options(glm::ivec2(1));
  automatic->frame.fit(scene, glm::vec3(camera.world_from_camera[3]), 0, settings.frame);
  settings.frame.of<VolumeOptions>().grid_box.reset();  // the session has its own
  settings.grid_fits_scene = false;
  return settings;
}

Settings DemoOptions::settings(std::vector<std::string>& unknown) const {
  Settings settings;
  if (const std::filesystem::path file = settings_path(); !file.empty()) {
    ReadSettings read = read_settings(file);
    settings = std::move(read.settings);
    unknown = std::move(read.unknown);
  }
  const app::FrameCommandOptions usual;
  if (frame.cells_times != usual.cells_times || frame.lights_times != usual.lights_times)
    throw Error(ExitCode::usage, "--cells-times, --lights-times: of volgi render; here --grid, --vpls and --vals");
  if (headless || frame.given()) {
    app::FrameCommandOptions asked = frame;
    if (frame.gi.empty() && !headless) asked.gi = settings.frame.recipe;  // the last one
    settings.frame = asked.frame_options(glm::ivec2(1));
    settings.grid_fits_scene = !frame.volume.grid_cells;
  }
  if (!preset.empty()) apply_preset(preset, settings);
  if (preset.empty() && frame.quality != usual.quality) apply_preset(frame.quality, settings);
  if (headless) settings.view = info(View::picture).name;
  if (!view.empty()) settings.view = info(view_of(view)).name;
  if (exposure == "auto") {
    settings.exposure_ev.reset();
  } else if (!exposure.empty()) {
    settings.exposure_ev = app::parse_number<double>(exposure);
    if (!settings.exposure_ev)
      throw Error(ExitCode::usage, "--exposure " + exposure + ": stops, such as -1.5, or auto");
  }
  return settings;
}

}  // namespace volgi::demo
