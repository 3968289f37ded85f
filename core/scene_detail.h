#pragma once
#include <glm/glm.hpp>
#include <optional>

#include "core/scene.h"

namespace volgi {

/// In the scene's centred frame [m].
struct SceneBox {
  glm::vec3 min{0.0f};
  glm::vec3 max{0.0f};
  glm::vec3 middle() const { return 0.5f * (min + max); }
};

/// What stands on a ground that is far larger: the box around all triangles but those that are longer than a quarter of
/// the scene and those that lie flat at its foot, and a margin. None where that is more than half of the scene: it is
/// then all alike. Cost: one look at every triangle.
std::optional<SceneBox> detail_box(const Scene& scene);

}  // namespace volgi
