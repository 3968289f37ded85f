#include "apps/demo/viewer.h"

#include <fmt/format.h>

#include <algorithm>
#include <ctime>

#include "apps/demo/camera_control.h"
#include "apps/demo/render_command.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "core/light_file.h"

namespace volgi::demo {

void Viewer::step(double seconds) {
  session.step(seconds);
  step_path(seconds);
  if (taken_light && session.has_scene() && *taken_light >= session.document().lights().size()) taken_light.reset();
  truth.step(session);
  under_cursor.clear();
  if (cursor && session.has_picture() && !session.moving()) under_cursor = session.picture().under(*cursor);
}

void Viewer::draw(glm::ivec2 size) {
  session.draw(size);
  show_truth();
  if (!screenshot_ || !session.has_picture() || session.moving()) return;
  try {
    write_screenshot(*std::exchange(screenshot_, std::nullopt));
  } catch (const Error& error) {
    session.say(error.what(), true);
  }
}

void Viewer::show_truth() {
  if (!session.has_picture() || truth.mode() == TruthMode::off || !truth.has_picture() || session.moving()) return;
  if (truth.is_new()) session.picture().new_truth(truth.radiance());
  const float wipe = truth.mode() == TruthMode::alone ? 0.0f : truth.wipe();
  gl::PassTimer& timer = session.untimed();
  timer.begin_frame();
  session.picture().show_truth(truth.radiance(), truth.mode() == TruthMode::error, wipe, session.exposure_ev(), timer);
  timer.end_frame();
}

void Viewer::time_passes(bool on) {
  times_passes = on;
  session.time_passes(on);
}

// --- Cameras.

std::vector<Bookmark>& Viewer::bookmarks() {
  return const_cast<Settings&>(session.settings()).bookmarks[session.document().files().front().string()];
}

void Viewer::keep_bookmark(const std::string& name) {
  std::vector<Bookmark>& kept = bookmarks();
  const std::string called = name.empty() ? fmt::format("view {}", kept.size() + 1) : name;
  const Bookmark bookmark{called, pose_of(session.camera(), session.document().scene())};
  const auto same = std::find_if(kept.begin(), kept.end(), [&](const Bookmark& b) { return b.name == called; });
  if (same != kept.end()) {
    *same = bookmark;
  } else {
    kept.push_back(bookmark);
  }
  session.say("kept: " + called);
}

void Viewer::go_to(const Bookmark& bookmark) {
  session.set_camera(camera_of(bookmark.pose, session.document().scene()));
}

void Viewer::next_bookmark() {
  const std::vector<Bookmark>& kept = bookmarks();
  if (kept.empty()) throw Error(ExitCode::usage, "no camera is kept yet; B keeps one");
  bookmark_ = (bookmark_ + 1) % kept.size();
  go_to(kept[bookmark_]);
  session.say(kept[bookmark_].name);
}

void Viewer::toggle_recording() {
  if (recording_) {
    constexpr double SMOOTH_S = 0.25;
    path_ = path_.smoothed(SMOOTH_S).thinned({});
    session.say(fmt::format("recorded {:.1f} s, {} keys", path_.last_time_s(), path_.keys().size()));
  } else {
    path_ = {};
    path_time_s_ = 0.0;
    replaying_ = false;
  }
  recording_ = !recording_;
}

void Viewer::toggle_replay() {
  if (!replaying_ && path_.empty()) throw Error(ExitCode::usage, "no path: V records one, path FILE reads one");
  replaying_ = !replaying_;
  recording_ = false;
  path_time_s_ = path_.first_time_s();
}

void Viewer::step_path(double seconds) {
  if (!session.has_scene()) return;
  const Scene& scene = session.document().scene();
  if (recording_) {
    path_.add({path_time_s_, pose_of(session.camera(), scene), session.document().time_s()});
    path_time_s_ += seconds;
  } else if (replaying_) {
    const CameraKey key = path_.at(path_time_s_);
    if (session.document().animated()) session.set_time(key.scene_time_s);
    session.set_camera(camera_of(key.pose, session.document().scene()));
    replaying_ = path_time_s_ < path_.last_time_s();
    path_time_s_ += seconds;
  }
}

// --- Files.

std::filesystem::path Viewer::next_screenshot_name() const {
  const std::string stem = session.document().scene().name;
  for (int k = 1;; ++k) {
    std::filesystem::path name = picture_folder / fmt::format("{}-{:03}", stem, k);
    if (!std::filesystem::exists(name.string() + ".png") && !std::filesystem::exists(name.string() + ".exr"))
      return name;
  }
}

std::string Viewer::render_command(const std::filesystem::path& out, const std::filesystem::path& light_file) const {
  return demo::render_command(session, out, light_file);
}

void Viewer::write_screenshot(const std::filesystem::path& name) {
  const auto with = [&](const char* ending) { return std::filesystem::path(name.string() + ending); };
  const Image image = session.picture().image();
  write_exr(with(".exr"), image);
  write_png(with(".png"), image, session.exposure_ev());
  std::filesystem::path light_file;
  if (session.document().light_changed()) {
    light_file = with(".lights.json");
    write_light_file(light_file, session.document().light_file(), session.document().scene().world_origin);
  }
  const std::string command = render_command(with(".png"), light_file);
  write_text_atomically(with(".txt"), command + '\n');
  session.say("wrote " + with(".png").string() + ", .exr and .txt");
}

void Viewer::save_settings() {
  if (settings_file_.empty()) throw Error(ExitCode::usage, "no place for settings: HOME is not set; use --settings");
  write_settings(settings_file_, session.settings());
  session.say("wrote " + settings_file_.string());
}

}  // namespace volgi::demo
