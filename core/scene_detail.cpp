#include "core/scene_detail.h"

#include <algorithm>
#include <array>
#include <limits>

namespace volgi {
namespace {

constexpr float LONG = 0.25f;    // of the scene's longest edge
constexpr float FOOT = 0.01f;    // of that, above the scene's lowest point
constexpr float FLAT = 0.2f;     // rise of a ground over its length
constexpr float MOST = 0.5f;     // of the scene's diagonal
constexpr float MARGIN = 0.05f;  // of the box's own

float longest(glm::vec3 v) { return std::max({v.x, v.y, v.z}); }

}  // namespace

std::optional<SceneBox> detail_box(const Scene& scene) {
  constexpr float FAR = std::numeric_limits<float>::infinity();
  const glm::vec3 extent = scene.bounds_max - scene.bounds_min;
  const float edge = longest(extent), foot = scene.bounds_min.y + FOOT * edge;
  SceneBox box{glm::vec3(FAR), glm::vec3(-FAR)};
  for (const Mesh& mesh : scene.meshes) {
    for (const glm::uvec3& t : mesh.triangles) {
      const std::array corners{mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z]};
      const glm::vec3 low = glm::min(glm::min(corners[0], corners[1]), corners[2]);
      const glm::vec3 high = glm::max(glm::max(corners[0], corners[1]), corners[2]);
      const glm::vec3 size = high - low;
      const bool ground = high.y < foot && size.y <= FLAT * longest(size);
      if (longest(size) > LONG * edge || ground) continue;
      box.min = glm::min(box.min, low);
      box.max = glm::max(box.max, high);
    }
  }
  if (!(box.min.x <= box.max.x)) return std::nullopt;
  const glm::vec3 margin(MARGIN * glm::length(box.max - box.min));
  box = {box.min - margin, box.max + margin};
  if (glm::length(box.max - box.min) > MOST * glm::length(extent)) return std::nullopt;
  return box;
}

}  // namespace volgi
