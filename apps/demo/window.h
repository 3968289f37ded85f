#pragma once
#include <array>
#include <filesystem>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "apps/demo/keys.h"
#include "core/gl/context.h"

struct GLFWwindow;

namespace volgi::demo {

struct WindowOptions {
  glm::ivec2 size{1280, 720};  // of the picture and the panels beside it, in the desktop's units
  std::string title = "volgi";
  bool gl_debug = false;
};

/// A window with an OpenGL 4.5 core context, current on this thread, and Dear ImGui on it.
class Window {
 public:
  /// @throws Error(no_device) without a display, or when it has no such context; says what to do instead.
  explicit Window(const WindowOptions& options);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  gl::Context& context() { return *context_; }
  bool asked_to_close() const;
  void close();  // asks itself
  /// In pixels; 0 while it is minimised.
  glm::ivec2 framebuffer_size() const;
  /// Pixels for each unit in which text is measured, on screens with many dots.
  float content_scale() const { return content_scale_; }
  bool minimised() const;
  void set_title(const std::string& title);
  void toggle_fullscreen();

  /// Takes what has happened; waits for it, `longest_s` at most, where that is above 0.
  void poll(double longest_s);
  /// Files that were dropped since the last call, and whether Shift was held.
  struct Drop {
    std::vector<std::filesystem::path> files;
    bool with_shift = false;
  };
  std::vector<Drop> take_drops();

  /// Keys that went down, or repeat, since the last call: none is lost to a slow frame.
  std::vector<KeyPress> take_keys() { return std::exchange(keys_, {}); }

  /// Where the left, right and middle button last went down: a slow frame sees the mouse where it has gone since.
  const std::array<glm::vec2, 3>& pressed_at() const { return pressed_at_; }

  void begin_gui();
  /// Draws the panels over the window, and shows it.
  void end_gui();

 private:
  static void on_key(GLFWwindow* window, int key, int code, int action, int modifiers);
  static void on_cursor(GLFWwindow* window, double x, double y);
  static void on_button(GLFWwindow* window, int button, int action, int modifiers);
  static void on_text(GLFWwindow* window, unsigned character);
  static void on_drop(GLFWwindow* window, int count, const char** paths);
  static void on_scale(GLFWwindow* window, float x, float y);
  void apply_scale(float scale);

  struct Toolkit;  // GLFW itself
  std::unique_ptr<Toolkit> toolkit_;
  GLFWwindow* window_ = nullptr;
  std::unique_ptr<gl::Context> context_;
  std::vector<Drop> drops_;
  std::vector<KeyPress> keys_;
  // ImGui 1.86 looks at keys once a frame: one that came up again meanwhile is told a frame later.
  struct Release {
    int key, code, modifiers;
  };
  std::vector<Release> late_releases_;
  std::vector<int> pressed_;  // since ImGui's last frame began
  glm::vec2 cursor_{0.0f};
  std::array<glm::vec2, 3> pressed_at_{};
  float content_scale_ = 0.0f;
  bool gui_ = false;
  glm::ivec4 windowed_{0};  // place and size before it filled the screen
};

}  // namespace volgi::demo
