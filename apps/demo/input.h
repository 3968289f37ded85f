#pragma once
#include <array>

#include "apps/demo/handles.h"
#include "apps/demo/keys.h"
#include "apps/demo/panels.h"
#include "apps/demo/viewer.h"

namespace volgi::demo {

/// Mouse and keys over the picture: what ImGui's panels do not want.
class Input {
 public:
  Input(Viewer& viewer, Panels& panels, Handles& handles) : viewer_(viewer), panels_(panels), handles_(handles) {}
  /// Once a frame, after ImGui's began. @param picture  size of the picture, which is at the window's upper left.
  /// @param keys  Window::take_keys(). @param pressed_at  Window::pressed_at().
  void step(double seconds, glm::ivec2 picture, const std::vector<KeyPress>& keys,
            const std::array<glm::vec2, 3>& pressed_at);

 private:
  void take(const KeyPress& press);
  void mouse(glm::ivec2 picture, const std::array<glm::vec2, 3>& pressed_at);
  void fly(double seconds);
  void press(int button, glm::vec2 at);
  void drag(int button, glm::vec2 by, glm::vec2 at, glm::ivec2 picture);
  glm::vec3 pivot_under(glm::vec2 pixel) const;

  Viewer& viewer_;
  Panels& panels_;
  Handles& handles_;
  int held_ = -1;  // button
  glm::vec3 pivot_{0.0f};
  float distance_m_ = 0.0f;  // to what was last taken hold of
};

}  // namespace volgi::demo
