#include "apps/demo/run_window.h"

#include <epoxy/gl.h>
#include <fmt/format.h>
#include <imgui.h>

#include <chrono>
#include <iostream>
#include <utility>

#include "apps/demo/commands.h"
#include "apps/demo/event_log.h"
#include "apps/demo/input.h"
#include "apps/demo/panels.h"
#include "apps/demo/shader_watch.h"
#include "apps/demo/viewer.h"
#include "apps/demo/window.h"
#include "core/error.h"
#include "screen/frame/registry.h"

namespace volgi::demo {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_between(Clock::time_point from, Clock::time_point to) {
  return std::chrono::duration<double>(to - from).count();
}

nlohmann::json numbers(glm::vec3 v) { return {v.x, v.y, v.z}; }

/// In the centred frame, as eyes and lights are told.
nlohmann::json frame_event(const Viewer& viewer) {
  const Session& session = viewer.session;
  const Document& document = session.document();
  return {{"frames", session.frames()},
          {"samples", session.picture().samples()},
          {"view", session.settings().view},
          {"recipe", screen::recipe_of(session.settings().frame).name},
          {"size", {session.size().x, session.size().y}},
          {"eye", numbers(glm::vec3(session.camera().world_from_camera[3]))},
          {"time", document.time_s()},
          {"triangles", document.scene().triangle_count()},
          {"reference", viewer.truth.samples()}};
}

const Light* taken_light(const Viewer& viewer) {
  if (!viewer.taken_light || !viewer.session.has_scene()) return nullptr;
  const auto& lights = viewer.session.document().lights();
  return *viewer.taken_light < lights.size() ? &lights[*viewer.taken_light] : nullptr;
}

/// Who gets the keys.
const char* keyboard_owner() {
  const ImGuiIO& io = ImGui::GetIO();
  return io.WantTextInput ? "text" : io.NavVisible ? "panels" : "picture";
}

/// A window at work: events in, pictures out.
class WindowLoop {
 public:
  WindowLoop(const DemoOptions& options, Settings settings);
  int run();

 private:
  void connect();
  void frame();
  void take_drops();
  void run_commands();
  void show_picture();
  void tell();
  void tell_messages();
  void pace();
  double longest_wait_s() const;

  const DemoOptions& options_;
  EventLog events_;
  Window window_;
  Viewer viewer_;
  Panels panels_;
  Handles handles_;
  Input input_;
  ShaderWatch shaders_;
  GLuint shown_framebuffer_ = 0;
  size_t told_messages_ = 0;
  std::uint64_t told_frames_ = 0;
  glm::vec3 told_light_{0.0f};
  std::string told_keyboard_;
  bool had_picture_ = false, commands_run_ = false, closing_ = false;
  Clock::time_point start_ = Clock::now(), last_ = start_, title_at_ = start_;
};

WindowLoop::WindowLoop(const DemoOptions& options, Settings settings)
    : options_(options),
      events_(options.events),
      window_({options.picture_size(), "volgi", options.device.context.debug}),
      viewer_(window_.context(), options.with_choice(std::move(settings), window_.context().device_name()),
              options.settings_path(), options.light, options.reading.reading),
      panels_(viewer_),
      handles_(viewer_),
      input_(viewer_, panels_, handles_),
      shaders_(options.shaders) {
  viewer_.picture_folder = options.pictures;
  connect();
  glCreateFramebuffers(1, &shown_framebuffer_);
  events_.add("window", {{"device", window_.context().device_name()}});
  viewer_.session.open(options.scenes, options.time_s);
}

void WindowLoop::connect() {
  viewer_.hooks.copy_text = [](const std::string& text) { ImGui::SetClipboardText(text.c_str()); };
  viewer_.hooks.toggle_fullscreen = [this] { window_.toggle_fullscreen(); };
  viewer_.hooks.quit = [this] { window_.close(); };
  viewer_.hooks.toggle_panel = [this](const std::string& name) { panels_.toggle(name); };
}

void WindowLoop::take_drops() {
  for (const Window::Drop& drop : window_.take_drops()) {
    if (drop.files.empty()) continue;
    if (drop.with_shift && viewer_.session.has_scene()) {
      for (const std::filesystem::path& file : drop.files) viewer_.session.append(file);
    } else {
      viewer_.session.open({drop.files.front()});
    }
  }
}

void WindowLoop::run_commands() {
  if (commands_run_ || !viewer_.session.has_picture()) return;
  commands_run_ = true;
  for (const std::string& line : options_.commands) {
    try {
      execute(viewer_, line);
    } catch (const Error& error) {
      viewer_.session.say(line + ": " + error.what(), true);
    }
  }
}

/// The picture at the window's upper left, the panels beside it.
void WindowLoop::show_picture() {
  const glm::ivec2 window = window_.framebuffer_size();
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  glViewport(0, 0, window.x, window.y);
  glDisable(GL_SCISSOR_TEST);
  constexpr float GREY[4] = {0.07f, 0.07f, 0.08f, 1.0f};
  glClearNamedFramebufferfv(0, GL_COLOR, 0, GREY);
  if (!viewer_.session.has_picture()) return;
  const glm::ivec2 size = viewer_.session.size(), from = viewer_.session.picture().size();
  glNamedFramebufferTexture(shown_framebuffer_, GL_COLOR_ATTACHMENT0, viewer_.session.picture().display().id(), 0);
  glBlitNamedFramebuffer(shown_framebuffer_, 0, 0, 0, from.x, from.y, 0, window.y - size.y, size.x, window.y,
                         GL_COLOR_BUFFER_BIT, from == size ? GL_NEAREST : GL_LINEAR);
}

void WindowLoop::tell_messages() {
  const Session& session = viewer_.session;
  const auto& messages = session.messages();
  const size_t untold = std::min(messages.size(), session.said() - std::exchange(told_messages_, session.said()));
  for (size_t k = messages.size() - untold; k < messages.size(); ++k) {
    events_.add(messages[k].error ? "error" : "message", {{"text", messages[k].text}});
    if (messages[k].error) std::cerr << "volgi-demo: " << messages[k].text << '\n';
  }
}

/// Title and events.
void WindowLoop::tell() {
  Session& session = viewer_.session;
  tell_messages();
  if (session.has_picture() && !had_picture_) events_.add("first_picture");
  had_picture_ = session.has_picture();
  if (session.frames() != told_frames_ && had_picture_) events_.add("frame", frame_event(viewer_));
  told_frames_ = session.frames();
  if (const Light* light = taken_light(viewer_); light != nullptr && light->position != told_light_) {
    events_.add("light", {{"light", *viewer_.taken_light}, {"at", numbers(light->position)}});
    told_light_ = light->position;
  }
  if (const char* owner = keyboard_owner(); owner != told_keyboard_) {
    events_.add("keyboard", {{"of", owner}});
    told_keyboard_ = owner;
  }
  const auto now = Clock::now();
  if (seconds_between(title_at_, now) < 0.5) return;
  title_at_ = now;
  const double ms = viewer_.times.median_ms();
  const std::string what = session.has_scene() ? session.document().title() : session.loader().title();
  window_.set_title(fmt::format("volgi: {}, {}{}", what, info(session.view()).title,
                                ms > 0.0 ? fmt::format(", {:.1f} ms", ms) : std::string()));
}

double WindowLoop::longest_wait_s() const {
  if (viewer_.session.loader().busy()) return 0.03;
  if (!viewer_.session.settled() || viewer_.replaying() || viewer_.recording()) return 0.0;
  return 0.1;  // a reference may have grown, a message may fade
}

void WindowLoop::frame() {
  window_.poll(longest_wait_s());
  take_drops();
  const auto now = Clock::now();
  const double seconds = seconds_between(last_, now);
  last_ = now;
  if (window_.minimised()) {
    window_.poll(0.1);
    return;
  }
  if (shaders_.changed()) viewer_.session.reload_shaders();
  const glm::ivec2 window = window_.framebuffer_size();
  glm::ivec2 picture = window;
  picture.x = std::max(1, window.x - panels_.width(window, window_.content_scale()));
  window_.begin_gui();
  input_.step(seconds, picture, window_.take_keys(), window_.pressed_at());
  viewer_.step(seconds);
  const std::uint64_t before = viewer_.session.frames();
  viewer_.draw(picture);
  run_commands();
  handles_.draw();
  panels_.draw(window, window_.content_scale());
  show_picture();
  window_.end_gui();
  if (viewer_.session.frames() != before) {
    const double ms = 1000.0 * seconds_between(now, Clock::now());
    viewer_.times.add(ms, viewer_.session.timer().latest());
    panels_.add_frame_time(ms);
  }
  tell();
}

int WindowLoop::run() {
  while (!window_.asked_to_close()) {
    frame();
    if (options_.quit_after_s && seconds_between(start_, Clock::now()) > *options_.quit_after_s) break;
  }
  if (!viewer_.settings_file().empty()) viewer_.save_settings();
  glDeleteFramebuffers(1, &shown_framebuffer_);
  events_.add("end", {{"gl_errors", window_.context().debug_errors()}});
  return int(ExitCode::done);
}

}  // namespace

int run_window(const DemoOptions& options) {
  std::vector<std::string> unknown;
  Settings settings = options.settings(unknown);
  for (const std::string& line : unknown) std::cerr << "volgi-demo: " << line << '\n';
  WindowLoop loop(options, std::move(settings));
  return loop.run();
}

}  // namespace volgi::demo
