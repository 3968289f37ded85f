#include "apps/demo/window.h"

#include <epoxy/gl.h>
// epoxy first: GLFW would bring the system's GL header
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>
#include <imgui_impl_glfw.h>
#include <imgui_impl_opengl3.h>

#include <algorithm>
#include <utility>

#include "apps/demo/x11.h"
#include "core/error.h"

namespace volgi::demo {

namespace {

constexpr const char* NO_DISPLAY_HINT = "--headless renders without one (volgi-demo --help)";

std::string last_glfw_error() {
  const char* text = nullptr;
  glfwGetError(&text);
  return text == nullptr ? "GLFW does not say why" : text;
}

/// Calm colours, so that the picture is what one sees.
void set_style(float scale) {
  ImGuiStyle style;
  ImGui::StyleColorsDark(&style);
  style.WindowRounding = 3.0f;
  style.FrameRounding = 2.0f;
  style.WindowBorderSize = 0.0f;
  style.Colors[ImGuiCol_WindowBg] = ImVec4(0.09f, 0.09f, 0.10f, 0.94f);
  style.Colors[ImGuiCol_NavHighlight] = ImVec4(1.0f, 0.75f, 0.3f, 1.0f);
  style.ScaleAllSizes(scale);
  ImGui::GetStyle() = style;
}

}  // namespace

struct Window::Toolkit {
  Toolkit() {
    glfwInitHint(GLFW_COCOA_CHDIR_RESOURCES, GLFW_FALSE);
    if (glfwInit() == GLFW_FALSE)
      throw Error(ExitCode::no_device, "no window: " + last_glfw_error() + "; " + NO_DISPLAY_HINT);
    end_with_display();
  }
  ~Toolkit() { glfwTerminate(); }
};

Window::Window(const WindowOptions& options) : toolkit_(std::make_unique<Toolkit>()) {
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_OPENGL_DEBUG_CONTEXT, options.gl_debug ? GLFW_TRUE : GLFW_FALSE);
  glfwWindowHint(GLFW_DEPTH_BITS, 0);
  glfwWindowHint(GLFW_STENCIL_BITS, 0);
  glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
  window_ = glfwCreateWindow(options.size.x, options.size.y, options.title.c_str(), nullptr, nullptr);
  if (window_ == nullptr)
    throw Error(ExitCode::no_device, "no window with OpenGL 4.5: " + last_glfw_error() + "; " + NO_DISPLAY_HINT);
  outlive_other_windows();
  glfwSetWindowUserPointer(window_, this);
  glfwMakeContextCurrent(window_);
  glfwSwapInterval(1);
  context_ = std::make_unique<gl::Context>(gl::OfWindow{.debug = options.gl_debug});

  ImGui::CreateContext();
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;  // settings are ours (apps/demo/settings.h)
  io.ConfigFlags |= ImGuiConfigFlags_NavEnableKeyboard;
  glfwSetWindowFocusCallback(window_, ImGui_ImplGlfw_WindowFocusCallback);
  glfwSetCursorEnterCallback(window_, ImGui_ImplGlfw_CursorEnterCallback);
  glfwSetMouseButtonCallback(window_, on_button);
  glfwSetCursorPosCallback(window_, on_cursor);
  glfwSetScrollCallback(window_, ImGui_ImplGlfw_ScrollCallback);
  glfwSetCharCallback(window_, on_text);
  glfwSetKeyCallback(window_, on_key);
  ImGui_ImplGlfw_InitForOpenGL(window_, false);
  ImGui_ImplOpenGL3_Init("#version 450 core");
  gui_ = true;
  float scale = 1.0f;
  glfwGetWindowContentScale(window_, &scale, nullptr);
  apply_scale(scale);
  glfwSetDropCallback(window_, on_drop);
  glfwSetWindowContentScaleCallback(window_, on_scale);
}

Window::~Window() {
  if (gui_) {
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
  }
  context_.reset();
  if (window_ != nullptr) glfwDestroyWindow(window_);
}

void Window::apply_scale(float scale) {
  if (scale == content_scale_ || !(scale > 0.0f)) return;
  content_scale_ = scale;
  set_style(scale);
  ImGuiIO& io = ImGui::GetIO();
  io.Fonts->Clear();
  ImFontConfig font;
  constexpr float TEXT_HEIGHT = 13.0f;
  font.SizePixels = TEXT_HEIGHT * scale;
  io.Fonts->AddFontDefault(&font);
  ImGui_ImplOpenGL3_DestroyFontsTexture();
  ImGui_ImplOpenGL3_CreateFontsTexture();
}

void Window::on_scale(GLFWwindow* window, float x, float /*y*/) {
  static_cast<Window*>(glfwGetWindowUserPointer(window))->apply_scale(x);
}

void Window::on_key(GLFWwindow* glfw_window, int key, int code, int action, int modifiers) {
  Window& window = *static_cast<Window*>(glfwGetWindowUserPointer(glfw_window));
  if (action == GLFW_RELEASE) {
    if (std::find(window.pressed_.begin(), window.pressed_.end(), key) != window.pressed_.end()) {
      window.late_releases_.push_back({key, code, modifiers});
      return;
    }
  } else {
    window.keys_.push_back({{key, (modifiers & GLFW_MOD_CONTROL) != 0, (modifiers & GLFW_MOD_SHIFT) != 0}, {}});
    if (action == GLFW_PRESS) window.pressed_.push_back(key);
  }
  ImGui_ImplGlfw_KeyCallback(glfw_window, key, code, action, modifiers);
}

void Window::on_cursor(GLFWwindow* window, double x, double y) {
  static_cast<Window*>(glfwGetWindowUserPointer(window))->cursor_ = {float(x), float(y)};
}

/// glfwGetCursorPos would ask where the cursor is by now; events come in their order.
void Window::on_button(GLFWwindow* glfw_window, int button, int action, int modifiers) {
  Window& window = *static_cast<Window*>(glfwGetWindowUserPointer(glfw_window));
  if (action == GLFW_PRESS && button >= 0 && size_t(button) < window.pressed_at_.size())
    window.pressed_at_[size_t(button)] = window.cursor_;
  ImGui_ImplGlfw_MouseButtonCallback(glfw_window, button, action, modifiers);
}

/// GLFW tells it right after the key.
void Window::on_text(GLFWwindow* glfw_window, unsigned character) {
  Window& window = *static_cast<Window*>(glfwGetWindowUserPointer(glfw_window));
  constexpr unsigned ASCII_END = 0x80;
  if (!window.keys_.empty() && character < ASCII_END) window.keys_.back().text += char(character);
  ImGui_ImplGlfw_CharCallback(glfw_window, character);
}

void Window::on_drop(GLFWwindow* window, int count, const char** paths) {
  Drop drop;
  for (int k = 0; k < count; ++k) drop.files.emplace_back(paths[k]);
  drop.with_shift = shift_is_down_anywhere() || glfwGetKey(window, GLFW_KEY_LEFT_SHIFT) == GLFW_PRESS ||
                    glfwGetKey(window, GLFW_KEY_RIGHT_SHIFT) == GLFW_PRESS;
  static_cast<Window*>(glfwGetWindowUserPointer(window))->drops_.push_back(std::move(drop));
}

std::vector<Window::Drop> Window::take_drops() { return std::exchange(drops_, {}); }

bool Window::asked_to_close() const { return glfwWindowShouldClose(window_) == GLFW_TRUE; }
void Window::close() { glfwSetWindowShouldClose(window_, GLFW_TRUE); }

glm::ivec2 Window::framebuffer_size() const {
  glm::ivec2 size(0);
  glfwGetFramebufferSize(window_, &size.x, &size.y);
  return size;
}

bool Window::minimised() const {
  const glm::ivec2 size = framebuffer_size();
  return glfwGetWindowAttrib(window_, GLFW_ICONIFIED) == GLFW_TRUE || size.x < 1 || size.y < 1;
}

void Window::set_title(const std::string& title) { glfwSetWindowTitle(window_, title.c_str()); }

void Window::toggle_fullscreen() {
  if (glfwGetWindowMonitor(window_) != nullptr) {
    glfwSetWindowMonitor(window_, nullptr, windowed_.x, windowed_.y, windowed_.z, windowed_.w, GLFW_DONT_CARE);
    return;
  }
  GLFWmonitor* monitor = glfwGetPrimaryMonitor();
  const GLFWvidmode* mode = monitor == nullptr ? nullptr : glfwGetVideoMode(monitor);
  if (mode == nullptr) return;
  glfwGetWindowPos(window_, &windowed_.x, &windowed_.y);
  glfwGetWindowSize(window_, &windowed_.z, &windowed_.w);
  glfwSetWindowMonitor(window_, monitor, 0, 0, mode->width, mode->height, mode->refreshRate);
}

void Window::poll(double longest_s) {
  if (longest_s > 0.0) {
    glfwWaitEventsTimeout(longest_s);
  } else {
    glfwPollEvents();
  }
}

void Window::begin_gui() {
  ImGui_ImplOpenGL3_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  ImGui::NewFrame();
  pressed_.clear();
}

void Window::end_gui() {
  ImGui::Render();
  // Not within a frame, where ImGui insists that modifiers stay as they were at its beginning.
  for (const Release& r : std::exchange(late_releases_, {}))
    ImGui_ImplGlfw_KeyCallback(window_, r.key, r.code, GLFW_RELEASE, r.modifiers);
  const glm::ivec2 size = framebuffer_size();
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  glViewport(0, 0, size.x, size.y);
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
  glfwSwapBuffers(window_);
}

}  // namespace volgi::demo
