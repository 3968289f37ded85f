#pragma once
#include <optional>

#include "apps/demo/viewer.h"

namespace volgi::demo {

/// Lights as marks over the picture, and handles of the one that is taken: along the three axes, in the picture's
/// plane, and for where it shines. Drawn with ImGui over everything else; moves lights by commands.
class Handles {
 public:
  explicit Handles(Viewer& viewer) : viewer_(viewer) {}
  void draw() const;
  /// @returns whether the mouse has hold of a handle or a mark: nobody else is to take it then.
  bool press(glm::vec2 pixel);
  void drag(glm::vec2 pixel);
  void release() { held_.reset(); }
  bool holds() const { return held_.has_value(); }

 private:
  enum class Part { x, y, z, plane, direction };
  struct Held {
    Part part;
    Light before;
    glm::vec2 from;
  };
  const Light* taken() const;
  float arm_m(const Light& light) const;
  glm::vec3 mark(const Light& light) const;
  glm::vec3 direction_end(const Light& light) const;
  std::optional<glm::vec2> pixel_of(glm::vec3 position) const;
  glm::vec3 moved_to(const Held& held, glm::vec2 pixel) const;

  Viewer& viewer_;
  std::optional<Held> held_;
};

}  // namespace volgi::demo
