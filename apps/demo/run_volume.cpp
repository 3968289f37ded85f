#include "apps/demo/run_volume.h"

#include <epoxy/gl.h>
#include <fmt/format.h>
#include <imgui.h>

#include <chrono>
#include <cmath>

#include "apps/demo/event_log.h"
#include "apps/demo/volume_panel.h"
#include "apps/demo/window.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "core/gl/objects.h"

namespace volgi::demo {

namespace {

using Clock = std::chrono::steady_clock;

void start(VolumeViewer& viewer, const DemoOptions& options) {
  viewer.picture_folder = options.pictures;
  if (!options.view.empty()) viewer.set_view(options.view);
  for (const std::string& line : options.commands) execute(viewer, line);
}

int picture(const DemoOptions& options) {
  const glm::ivec2 size = options.picture_size();
  if (!options.path.empty() || !options.benchmark.empty())
    throw Error(ExitCode::usage,
                "--path and --benchmark are for scenes; a volume has --view and --do \"orbit YAW,PITCH\"");
  if (options.out.extension() != ".png")
    throw Error(ExitCode::usage, "--headless: a volume's picture needs -o with a name that ends in .png");
  check_writable(options.out);
  VolumeViewer viewer(options.scenes.front());
  start(viewer, options);
  if (const auto screenshot = viewer.take_screenshot()) write_png_display(*screenshot, viewer.picture(size));
  write_png_display(options.out, viewer.picture(size));
  fmt::print("wrote {} ({})\n{}\n", options.out.string(), viewer.view(), cell_text(viewer.field(), viewer.look().cell));
  return int(ExitCode::done);
}

/// A picture on the window's upper left.
class ShownPicture {
 public:
  ShownPicture() {
    GLuint id = 0;
    glCreateFramebuffers(1, &id);
    framebuffer_ = gl::Handle<gl::delete_framebuffer>(id);
  }

  void show(const Image& picture, glm::ivec2 size, glm::ivec2 window) {
    upload(picture);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    constexpr float GREY[4] = {0.07f, 0.07f, 0.08f, 1.0f};
    glClearNamedFramebufferfv(0, GL_COLOR, 0, GREY);
    // The picture's first row is the upper one.
    glBlitNamedFramebuffer(framebuffer_.id(), 0, 0, 0, size_.x, size_.y, 0, window.y, size.x, window.y - size.y,
                           GL_COLOR_BUFFER_BIT, GL_NEAREST);
  }

 private:
  void upload(const Image& picture) {
    if (size_ != glm::ivec2(picture.width, picture.height)) {
      size_ = {picture.width, picture.height};
      GLuint id = 0;
      glCreateTextures(GL_TEXTURE_2D, 1, &id);
      texture_ = gl::Handle<gl::delete_texture>(id);
      glTextureStorage2D(id, 1, GL_RGBA8, size_.x, size_.y);
      glNamedFramebufferTexture(framebuffer_.id(), GL_COLOR_ATTACHMENT0, id, 0);
    }
    glTextureSubImage2D(texture_.id(), 0, 0, 0, size_.x, size_.y, GL_RGB, GL_FLOAT, picture.pixels.data());
  }

  gl::Handle<gl::delete_framebuffer> framebuffer_;
  gl::Handle<gl::delete_texture> texture_;
  glm::ivec2 size_{0};
};

class VolumeWindow {
 public:
  explicit VolumeWindow(const DemoOptions& options)
      : options_(options),
        events_(options.events),
        viewer_(options.scenes.front()),
        window_({options.picture_size(), "volgi", options.device.context.debug}) {
    start(viewer_, options);
    events_.add("window", {{"device", window_.context().device_name()}});
  }

  int run() {
    const auto begin = Clock::now();
    while (!window_.asked_to_close() && !viewer_.asked_to_quit) {
      frame();
      if (options_.quit_after_s && std::chrono::duration<double>(Clock::now() - begin).count() > *options_.quit_after_s)
        break;
    }
    events_.add("end", {{"gl_errors", window_.context().debug_errors()}});
    return int(ExitCode::done);
  }

 private:
  void frame() {
    constexpr double LONGEST_WAIT_S = 0.1;
    window_.poll(turning_ || was_quick_ ? 0.0 : LONGEST_WAIT_S);
    if (window_.minimised()) return;
    take_drops();
    const glm::ivec2 window = window_.framebuffer_size();
    size_ = {std::max(1, window.x - volume_panel_width(viewer_, window, window_.content_scale())), window.y};
    window_.begin_gui();
    for (const KeyPress& press : window_.take_keys()) take(press);
    mouse();
    draw_volume_panel(viewer_, window, window_.content_scale());
    was_quick_ = turning_;
    picture_.show(viewer_.picture(size_, turning_), size_, window);
    window_.end_gui();
    if (const auto file = viewer_.take_screenshot()) write_screenshot(*file);
    tell();
  }

  void take_drops() {
    for (const Window::Drop& drop : window_.take_drops()) {
      if (drop.files.empty()) continue;
      try {
        viewer_ = VolumeViewer(drop.files.front());
        viewer_.picture_folder = options_.pictures;
      } catch (const Error& error) {
        viewer_.message = error.what();
      }
    }
  }

  void take(const KeyPress& press) {
    const ImGuiIO& io = ImGui::GetIO();
    if (io.WantTextInput) return;
    if (press.key == parse_key("Tab") && io.NavVisible) return;
    for (const KeyBinding& binding : volume_key_bindings()) {
      if (parse_key(binding.key) == press.key) return run_or_say(viewer_, binding.command);
    }
  }

  void mouse() {
    const ImGuiIO& io = ImGui::GetIO();
    const glm::ivec2 at(int(io.MousePos.x), int(io.MousePos.y));
    const auto part = part_at(viewer_.look(), size_, at);
    const bool over = !io.WantCaptureMouse && at.x >= 0 && at.y >= 0 && at.x < size_.x && at.y < size_.y;
    if (over && ImGui::IsMouseClicked(0)) held_ = part;
    if (!ImGui::IsMouseDown(0)) held_.reset();
    turning_ = held_ == VolumePart::orbit && (io.MouseDelta.x != 0.0f || io.MouseDelta.y != 0.0f);
    constexpr double DEGREES_A_PIXEL = 0.5, A_NOTCH = 1.15;
    if (turning_) viewer_.orbit(-DEGREES_A_PIXEL * double(io.MouseDelta.x), DEGREES_A_PIXEL * double(io.MouseDelta.y));
    if ((held_ && held_ != VolumePart::orbit && held_ == part) || (over && ImGui::IsMouseClicked(1))) {
      if (const auto cell = cell_at(viewer_.field(), viewer_.scalars(), viewer_.look(), size_, at))
        viewer_.choose_cell(*cell);
    }
    if (!over || io.MouseWheel == 0.0f || !part) return;
    if (*part == VolumePart::orbit) return viewer_.zoom(std::pow(A_NOTCH, double(io.MouseWheel)));
    glm::ivec3 by(0);
    by[int(*part)] = io.MouseWheel > 0.0f ? 1 : -1;
    viewer_.move_cell(by);
  }

  void write_screenshot(const std::filesystem::path& file) {
    try {
      write_png_display(file, viewer_.picture(size_));
      viewer_.message = "wrote " + file.string();
    } catch (const Error& error) {
      viewer_.message = error.what();
    }
  }

  /// Title, and what tests watch.
  void tell() {
    const VolumeLook& look = viewer_.look();
    const nlohmann::json state = {{"file", viewer_.file().string()},
                                  {"grid", viewer_.field().name},
                                  {"channel", look.channel},
                                  {"view", viewer_.view()},
                                  {"cell", {viewer_.cell().x, viewer_.cell().y, viewer_.cell().z}},
                                  {"orbit", {look.yaw_deg, look.pitch_deg, look.zoom}},
                                  {"direction", {viewer_.direction_deg().x, viewer_.direction_deg().y}},
                                  {"size", {size_.x, size_.y}},
                                  {"message", viewer_.message}};
    if (state == told_) return;
    if (told_.is_null()) events_.add("first_picture");
    events_.add("frame", state);
    told_ = state;
    window_.set_title(fmt::format("volgi: {}, {}", viewer_.file().filename().string(), viewer_.field().name));
  }

  const DemoOptions& options_;
  EventLog events_;
  VolumeViewer viewer_;
  Window window_;
  ShownPicture picture_;
  glm::ivec2 size_{1};
  std::optional<VolumePart> held_;
  bool turning_ = false, was_quick_ = false;
  nlohmann::json told_;
};

}  // namespace

bool is_volume(const DemoOptions& options) {
  size_t volumes = 0;
  for (const std::filesystem::path& file : options.scenes) volumes += is_volume_file(file) ? 1 : 0;
  if (volumes > 0 && options.scenes.size() > 1)
    throw Error(ExitCode::usage, "a volume (.vdb) is looked at alone; give it without other files");
  return volumes == 1;
}

int run_volume(const DemoOptions& options) {
  if (options.headless || !options.benchmark.empty()) return picture(options);
  return VolumeWindow(options).run();
}

}  // namespace volgi::demo
