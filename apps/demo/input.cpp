#include "apps/demo/input.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui.h>

#include <cmath>

#include "apps/demo/camera_control.h"
#include "apps/demo/commands.h"
#include "core/error.h"

namespace volgi::demo {

namespace {

constexpr double RADIANS_A_PIXEL = 0.006;
enum Button { LEFT = 0, RIGHT = 1, MIDDLE = 2 };

glm::vec2 mouse_at() {
  const ImGuiIO& io = ImGui::GetIO();
  return {io.MousePos.x, io.MousePos.y};
}

}  // namespace

void Input::step(double seconds, glm::ivec2 picture, const std::vector<KeyPress>& keys,
                 const std::array<glm::vec2, 3>& pressed_at) {
  for (const KeyPress& press : keys) take(press);
  if (!viewer_.session.has_picture()) return;
  mouse(picture, pressed_at);
  fly(seconds);
}

/// ImGui moves within panels by keys while one of them has the keyboard; Escape gives it back to the picture.
void Input::take(const KeyPress& press) {
  const ImGuiIO& io = ImGui::GetIO();
  const Key& key = press.key;
  if (io.WantTextInput) return;
  if (panels_.palette_waits()) {
    panels_.type_ahead(press);
    return;
  }
  if (key.key == GLFW_KEY_ESCAPE) ImGui::SetWindowFocus(nullptr);
  const bool of_panels = key.key == GLFW_KEY_SPACE || key.key == GLFW_KEY_TAB;
  if (of_panels && io.NavVisible && !key.control) return;
  for (const KeyBinding& binding : key_bindings()) {
    if (!(parse_key(binding.key) == key)) continue;
    try {
      execute(viewer_, binding.command);
    } catch (const Error& error) {
      viewer_.session.say(error.what(), true);
    }
    return;
  }
}

glm::vec3 Input::pivot_under(glm::vec2 pixel) const {
  if (const auto hit = viewer_.session.world_under(pixel)) return *hit;
  // In front of the camera, as far as what was turned around last.
  const glm::mat4& eye = viewer_.session.camera().world_from_camera;
  const Scene& scene = viewer_.session.document().scene();
  const float distance = distance_m_ > 0.0f ? distance_m_ : 0.5f * glm::distance(scene.bounds_min, scene.bounds_max);
  return glm::vec3(eye[3]) - distance * glm::vec3(eye[2]);
}

void Input::press(int button, glm::vec2 at) {
  held_ = button;
  if (button == LEFT && handles_.press(at)) return;
  pivot_ = pivot_under(at);
  distance_m_ = glm::distance(pivot_, glm::vec3(viewer_.session.camera().world_from_camera[3]));
}

void Input::drag(int button, glm::vec2 by, glm::vec2 at, glm::ivec2 picture) {
  Session& session = viewer_.session;
  if (handles_.holds()) {
    handles_.drag(at);
    return;
  }
  const double yaw = -RADIANS_A_PIXEL * double(by.x), pitch = -RADIANS_A_PIXEL * double(by.y);
  const bool turns_sky = ImGui::GetIO().KeyShift && button == RIGHT && !session.document().sky().empty();
  try {
    if (turns_sky) {
      execute(viewer_, fmt::format("sky-rotate {}", session.document().sky_rotate_deg() + 0.5 * double(by.x)));
    } else if (button == LEFT) {
      session.set_camera(orbited(session.camera(), pivot_, yaw, pitch));
    } else if (button == MIDDLE) {
      session.set_camera(panned(session.camera(), pivot_, by, picture));
    } else {
      session.set_camera(flown(session.camera(), {glm::vec3(0.0f), yaw, pitch}, 0.0));
    }
  } catch (const Error& error) {
    session.say(error.what(), true);
  }
}

void Input::mouse(glm::ivec2 picture, const std::array<glm::vec2, 3>& pressed_at) {
  const ImGuiIO& io = ImGui::GetIO();
  const glm::vec2 at = mouse_at();
  const bool over =
      !io.WantCaptureMouse && at.x >= 0.0f && at.y >= 0.0f && at.x < float(picture.x) && at.y < float(picture.y);
  viewer_.cursor = over ? std::optional(at) : std::nullopt;
  for (int button = 0; button < 3; ++button) {
    if (over && held_ < 0 && ImGui::IsMouseClicked(button)) press(button, pressed_at[size_t(button)]);
    if (held_ == button && !ImGui::IsMouseDown(button)) {
      held_ = -1;
      handles_.release();
    }
  }
  const glm::vec2 by(io.MouseDelta.x, io.MouseDelta.y);
  if (held_ >= 0 && by != glm::vec2(0.0f)) drag(held_, by, at, picture);
  if (over && io.MouseWheel != 0.0f) {
    constexpr double A_NOTCH = 0.85;
    const glm::vec3 pivot = pivot_under(at);
    viewer_.session.set_camera(dollied(viewer_.session.camera(), pivot, std::pow(A_NOTCH, double(io.MouseWheel))));
  }
}

void Input::fly(double seconds) {
  const ImGuiIO& io = ImGui::GetIO();
  if (io.WantTextInput || io.KeyCtrl) return;
  const auto held = [](char key) { return ImGui::IsKeyDown(key) ? 1.0f : 0.0f; };
  const glm::vec3 way(held('D') - held('A'), held('E') - held('Q'), held('W') - held('S'));
  if (way == glm::vec3(0.0f)) return;
  const Scene& scene = viewer_.session.document().scene();
  const float speed = typical_speed_m_per_s(scene.bounds_min, scene.bounds_max) * (io.KeyShift ? 4.0f : 1.0f);
  // A slow frame does not throw one through a wall.
  constexpr double LONGEST_S = 0.25;
  viewer_.session.set_camera(flown(viewer_.session.camera(), {way * speed, 0.0, 0.0}, std::min(seconds, LONGEST_S)));
}

}  // namespace volgi::demo
