#pragma once
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "apps/demo/camera_path.h"
#include "apps/demo/session.h"
#include "apps/demo/time_log.h"
#include "apps/demo/truth.h"

namespace volgi::demo {

/// What a window adds to a session: the reference beside it, cameras that are kept, recorded and replayed, pictures
/// that are written. Everything that a person can do goes through commands (apps/demo/commands.h), which work on this.
class Viewer {
 public:
  Viewer(const gl::Context& context, Settings settings, std::filesystem::path settings_file,
         app::LightOptions light_options, SceneReading reading = {})
      : session(context, std::move(settings), std::move(light_options), std::move(reading)),
        settings_file_(std::move(settings_file)) {}

  Session session;
  Truth truth;
  std::optional<size_t> taken_light;  // in session.document().lights()
  std::optional<glm::vec2> cursor;    // over the picture [pixels], y down
  std::string under_cursor;           // what is there, in words
  std::filesystem::path picture_folder = ".";
  TimeLog times;
  bool times_passes = false;

  /// What only the window can do.
  struct Hooks {
    std::function<void(const std::string&)> copy_text = [](const std::string&) {};
    std::function<void()> toggle_fullscreen = [] {};
    std::function<void()> quit = [] {};
    std::function<void(const std::string& panel)> toggle_panel = [](const std::string&) {};
  } hooks;

  /// Lets time pass: what is loaded, played, recorded, traced.
  void step(double seconds);
  void time_passes(bool on);
  /// Renders, and draws the view with the reference over it.
  void draw(glm::ivec2 size);

  // --- Cameras.
  void keep_bookmark(const std::string& name);
  std::vector<Bookmark>& bookmarks();
  void go_to(const Bookmark& bookmark);
  void next_bookmark();
  void toggle_recording();
  void toggle_replay();
  bool recording() const { return recording_; }
  bool replaying() const { return replaying_; }
  CameraPath& path() { return path_; }

  // --- Files.
  /// PNG, EXR, a text with the command, and what the command needs, beside each other: NAME.png and so on, after the
  /// next draw(), so that they are of one picture.
  void want_screenshot(const std::filesystem::path& name) { screenshot_ = name; }
  std::filesystem::path next_screenshot_name() const;
  /// `volgi render ...`. @param light_file  where lights have been changed; empty: left out.
  std::string render_command(const std::filesystem::path& out, const std::filesystem::path& light_file) const;
  void save_settings();
  const std::filesystem::path& settings_file() const { return settings_file_; }

 private:
  void step_path(double seconds);
  void show_truth();
  void write_screenshot(const std::filesystem::path& name);

  std::filesystem::path settings_file_;
  CameraPath path_;
  bool recording_ = false, replaying_ = false;
  double path_time_s_ = 0.0;
  size_t bookmark_ = 0;
  std::optional<std::filesystem::path> screenshot_;
};

}  // namespace volgi::demo
