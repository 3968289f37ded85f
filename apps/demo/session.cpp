#include "apps/demo/session.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "apps/demo/camera_arguments.h"
#include "apps/demo/camera_control.h"
#include "apps/demo/render_command.h"
#include "core/error.h"
#include "core/surface.h"
#include "propagation/volume_options.h"
#include "screen/frame/registry.h"

namespace volgi::demo {

namespace {

/// Whether they make the same frame.
bool same_frame(const Settings& a, const Settings& b) {
  return frame_arguments(a.frame, a.grid_fits_scene) == frame_arguments(b.frame, b.grid_fits_scene);
}

/// Other settings, with what is no step of undo as it is now.
Settings as_step(Settings settings, const Settings& now) {
  settings.panels = now.panels;
  settings.bookmarks = now.bookmarks;
  settings.recent_files = now.recent_files;
  settings.as_read = now.as_read;
  return settings;
}

}  // namespace

Session::Session(const gl::Context& context, Settings settings, app::LightOptions light, SceneReading reading)
    : software_(context.software()),
      settings_(std::move(settings)),
      good_settings_(settings_),
      light_(std::move(light)),
      reading_(std::move(reading)),
      timer_(std::make_unique<gl::PassTimer>(software_, false)),
      untimed_(std::make_unique<gl::PassTimer>(software_, false)) {}

// --- What is open.

void Session::open(std::vector<std::filesystem::path> files, double time_s) {
  loader_.start(std::move(files), light_, time_s, reading_);
}

void Session::append(const std::filesystem::path& file) {
  std::vector<std::filesystem::path> files;
  if (loader_.busy()) {
    files = loader_.files();
  } else if (document_) {
    files = document_->files();
  }
  files.push_back(file);
  loader_.start(std::move(files), light_, document_ ? document_->time_s() : 0.0, reading_);
}

void Session::wait_for_scene() {
  SceneLoader::Result result = loader_.wait();
  if (!result.document) throw Error(ExitCode(result.exit_code), result.error);
  take(std::move(result));
}

void Session::take(SceneLoader::Result result) {
  if (!result.document) {
    say(result.error, true);
    return;
  }
  const bool more_of_same = document_ && result.document->files().size() > 1 &&
                            result.document->files().front() == document_->files().front();
  const glm::dvec3 old_origin = document_ ? document_->scene().world_origin : glm::dvec3(0.0);
  // The frame and its triangles are of the old scene.
  full_ = {};
  quick_ = {};
  quick_shown_ = false;
  triangles_.reset();
  document_ = std::move(result.document);
  for (const std::filesystem::path& file : document_->files()) add_recent_file(settings_, file);
  if (more_of_same) {
    camera_.world_from_camera[3] += glm::vec4(glm::vec3(old_origin - document_->scene().world_origin), 0.0f);
    set_camera(camera_);
  } else {
    if (document_->cameras().empty()) {
      set_camera(document_->first_camera());
    } else {
      take_file_camera(0);
    }
    playing_ = false;
  }
  if (document_->has_default_light())
    say(document_->title() + ": no light and nothing that glows: a soft sky, and a lamp beside the camera");
  want_frames();
  scene_has_changed();
}

void Session::restart() {
  restart_ = true;
  failure_.reset();
  ++picture_version_;
}

void Session::scene_has_changed() {
  ++scene_version_;
  restart();
}

// --- How it is rendered.

bool Session::change(const std::string& what, const Settings& settings) {
  const Settings before = settings_;
  settings_ = settings;
  try {
    view();
    const screen::FrameOptions options = frame_options(glm::max(asked_size_, glm::ivec2(1)));
    const screen::Recipe recipe = screen::recipe_of(options);
    if (document_)
      screen::plan_picture(recipe, options, screen::paths_in(document_->scene()), shines(document_->scene()));
  } catch (const Error& error) {
    settings_ = before;
    say(error.what(), true);
    return false;
  }
  undo_.add(what, before);
  if (!same_frame(before, settings_)) want_frames();
  restart();
  return true;
}

void Session::undo() {
  if (!undo_.can_undo()) return;
  say("undone: " + undo_.steps().back().what);
  settings_ = as_step(undo_.undo(settings_), settings_);
  want_frames();
  restart();
}

void Session::redo() {
  if (!undo_.can_redo()) return;
  say("done again: " + undo_.undone().back().what);
  settings_ = as_step(undo_.redo(settings_), settings_);
  want_frames();
  restart();
}

screen::FrameOptions Session::frame_options(glm::ivec2 size) const {
  screen::FrameOptions options = settings_.frame;
  options.size = size;
  if (settings_.grid_fits_scene && document_) options.of<VolumeOptions>().grid_cells = document_->grid_cells();
  options.of<VolumeOptions>().bounces = options.bounces;
  return options;
}

screen::TypeMap Session::recipe_settings() const {
  screen::FrameOptions fresh;
  if (!settings_.frame.recipe.empty()) screen::apply_recipe(settings_.frame.recipe, fresh);
  return fresh.settings;
}

void Session::reload_shaders() {
  want_frames();
  full_.picture_wanted = quick_.picture_wanted = true;
  restart();
}

// --- From where.

void Session::set_camera(const Camera& camera) {
  const Scene& scene = document_->scene();
  const Camera fitted = with_depth_of(camera, scene.bounds_min, scene.bounds_max);
  camera_arguments_ = demo::camera_arguments(fitted, scene);
  camera_ = camera_of_arguments(fitted, scene);
  file_camera_.reset();
  restart();
}

void Session::take_file_camera(size_t index) {
  const auto& cameras = document_->cameras();
  if (index >= cameras.size())
    throw Error(ExitCode::usage,
                fmt::format("camera {}: {} has {}, counted from 0", index, document_->title(), cameras.size()));
  camera_ = cameras[index];
  camera_arguments_ = fmt::format("--camera {}", index);
  file_camera_ = index;
  restart();
}

// --- Light and time.

void Session::light_changed(bool kinds) {
  if (kinds) want_frames();
  scene_has_changed();
}

void Session::set_time(double time_s) {
  if (!has_scene() || !document_->animated()) return;
  if (document_->move(std::max(time_s, 0.0))) {
    triangles_.reset();
    for (Canvas* c : {&full_, &quick_}) c->wanted = c->other_images = true;
  }
  if (file_camera_) camera_ = document_->cameras()[std::min(*file_camera_, document_->cameras().size() - 1)];
  full_.moved = quick_.moved = true;
  scene_has_changed();
}

// --- Each frame.

void Session::step(double seconds) {
  if (std::optional<SceneLoader::Result> result = loader_.take()) take(std::move(*result));
  if (!has_scene()) return;
  if (playing_) {
    const double duration = document_->duration_s();
    const double time = document_->time_s() + seconds;
    set_time(duration > 0.0 ? std::fmod(time, duration) : time);
  }
  if (has_picture()) picture().adapt(seconds);
}

bool Session::settled() const {
  if (!has_scene()) return !loader_.busy();
  if (failure_) return true;
  if (playing_ || quick_shown_ || full_.wanted || full_.moved || restart_ || !has_picture()) return false;
  return picture().samples() >= (settings_.progressive ? settings_.most_samples : 1);
}

/// The quick one while something moves and the full one has been too slow.
void Session::choose_canvas() {
  const auto now = MotionPace::Clock::now();
  if (restart_ || playing_) pace_.moved(now);
  const bool moving = pace_.moving(now);
  const bool quick = moving && pace_.level() > 0 && full_.picture;
  if (quick && quick_level_ != pace_.level()) {
    quick_level_ = pace_.level();
    quick_.wanted = true;
  }
  if (quick == quick_shown_) return;
  const Picture* before = canvas().picture.get();
  quick_shown_ = quick;
  if (canvas().picture && before != nullptr) canvas().picture->take_exposure(*before);
  restart_ = true;  // of the other's average; the picture is the same
}

void Session::draw(glm::ivec2 size) {
  if (!has_scene() || size.x < 1 || size.y < 1) return;
  if (std::exchange(asked_size_, size) != size) failure_.reset();
  const bool was_moving = pace_.moving(MotionPace::Clock::now());
  choose_canvas();
  const std::uint64_t before = frames_;
  gl::PassTimer* timer = untimed_.get();
  bool mended = false;
  std::optional<Canvas> before_shaders;
  try {
    const glm::ivec2 canvas_size = motion_size(motion_level(), size);
    if (!failure_ && (canvas().wanted || canvas_size != canvas().size || !canvas().frame))
      before_shaders = make_frame(canvas_size);
    if (!settled() && (restart_ || playing_ || !quick_shown_)) {
      timer = timer_.get();
      timer->begin_frame();
      render();
      gl::throw_on_error();
    }
    if (!failure_) good_settings_ = settings_;
  } catch (const Error& error) {
    say(error.what(), true);
    if (before_shaders) canvas() = std::move(*before_shaders);
    // Back to what could be; where that is what fails, there is nothing to try.
    if (same_frame(settings_, good_settings_)) failure_ = error;
    settings_ = as_step(good_settings_, settings_);
    mended = !failure_;
    if (mended) want_frames();
  }
  if (timer == untimed_.get()) timer->begin_frame();
  if (has_picture()) {
    warn_of_view();
    picture().show(frame(), document_->scene(), camera_, details_, settings_, *timer);
  }
  timer->end_frame();
  if (mended) return draw(size);
  if (!has_picture()) return;
  const auto now = MotionPace::Clock::now();
  if (was_moving && frames_ != before)
    pace_.shown(std::chrono::duration<double>(now - shown_at_).count(), settings_.motion_fps);
  shown_at_ = now;
}

/// Says once what a view lacks.
void Session::warn_of_view() {
  const std::string why = why_not(view(), frame());
  if (why == warned_view_) return;
  warned_view_ = why;
  if (!why.empty()) say(std::string(info(view()).title) + ": " + why);
}

void Session::want_frames() {
  full_.wanted = quick_.wanted = true;
  pace_.reset();
}

/// The old frame goes when the new one is there: a setting or a shader that cannot be leaves it.
/// @returns it where shaders have been read anew: stages compile some of theirs when they first run.
std::optional<Session::Canvas> Session::make_frame(glm::ivec2 size) {
  Canvas& c = canvas();
  c.wanted = false;
  const bool other_shaders = std::exchange(c.picture_wanted, false);
  const bool other_picture = other_shaders || size != c.size || !c.picture;
  std::unique_ptr<screen::Frame> made;
  std::unique_ptr<Picture> picture;
  // The quick one's programs go to the next; should that fail, there is the full one.
  if (std::exchange(c.other_images, false) || quick_shown_) c.frame.reset();
  if (triangles_) triangles_->set_materials(document_->scene().materials);
  try {
    screen::FrameOptions options = frame_options(size);
    apply_motion_level(motion_level(), options);
    made = std::make_unique<screen::Frame>(document_->scene(), options, screen::recipe_of(options), triangles_);
    if (other_picture) picture = std::make_unique<Picture>(size);
  } catch (const Error& error) {
    if (!c.frame || size != c.size) throw;
    say(error.what(), true);
    settings_ = as_step(good_settings_, settings_);
    return std::nullopt;
  }
  std::optional<Canvas> before;
  if (other_shaders && c.frame) before = Canvas{std::move(c.frame), nullptr, c.size, false, c.moved, false, false};
  c.frame = std::move(made);
  triangles_ = c.frame->triangles();
  if (picture) {
    const Picture* shown = c.picture ? c.picture.get() : (quick_shown_ ? full_ : quick_).picture.get();
    if (shown != nullptr) picture->take_exposure(*shown);
    if (before) before->picture = std::move(c.picture);
    c.picture = std::move(picture);
    c.size = size;
  }
  c.moved = false;
  restart_ = true;
  return before;
}

void Session::render() {
  Canvas& c = canvas();
  if (std::exchange(c.moved, false)) c.frame->follow_scene(*timer_);
  if (restart_ || playing_) c.picture->restart();
  restart_ = false;
  c.frame->show(paths_of(view()).value_or(screen::LightPaths::all()));
  c.frame->set_sample(c.picture->samples(), settings_.progressive);
  c.frame->render(camera_, *timer_);
  c.picture->add(c.frame->radiance(), *timer_);
  ++frames_;
}

void Session::time_passes(bool on) { timer_ = std::make_unique<gl::PassTimer>(software_, on); }

std::optional<glm::vec3> Session::world_under(glm::vec2 pixel) const {
  if (!has_picture()) return std::nullopt;
  const glm::ivec2 there = canvas().size;
  const glm::vec2 part = pixel / glm::vec2(glm::max(asked_size_, glm::ivec2(1)));
  const glm::ivec2 at(part.x * float(there.x), (1.0f - part.y) * float(there.y));
  if (glm::any(glm::lessThan(at, glm::ivec2(0))) || glm::any(glm::greaterThanEqual(at, there))) return std::nullopt;
  glm::vec4 texel(0.0f);
  glGetTextureSubImage(frame().gbuffer().position().id(), 0, at.x, at.y, 0, 1, 1, 1, GL_RGBA, GL_FLOAT, sizeof(texel),
                       &texel);
  if (texel.w == 0.0f) return std::nullopt;
  return glm::vec3(texel);
}

// --- What there is to say.

void Session::say(std::string text, bool error) {
  constexpr size_t MOST = 100;
  messages_.push_back({std::move(text), error, std::chrono::steady_clock::now()});
  ++said_;
  if (messages_.size() > MOST) messages_.erase(messages_.begin());
}

}  // namespace volgi::demo
