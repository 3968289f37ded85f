#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>

#include "core/surface.h"
#include "core/visibility/embree_scene.h"
#include "core/visibility/even_direction_internal.h"

namespace volgi {

/// A ray's way from surface to surface, on from each as diffuse light goes. The k-th of many from one place, even over
/// all directions.
class DiffusePath {
 public:
  DiffusePath(const EmbreeScene& embree, glm::vec3 origin, std::uint32_t k)
      : embree_(embree), origin_(origin), direction_(even_direction(k)), k_(k) {}

  /// To the next surface. False when there is none.
  bool step() {
    constexpr float FAR = std::numeric_limits<float>::infinity();
    if (!embree_.intersect(origin_, direction_, FAR, k_, hit_)) return false;
    const Scene& scene = embree_.scene();
    const SurfacePoint at = surface_point(scene, scene.meshes[hit_.mesh], hit_.triangle, hit_.u, hit_.v);
    const glm::vec3 normal =
        glm::dot(at.geometric_normal, direction_) < 0.0f ? at.geometric_normal : -at.geometric_normal;
    position_ = at.position;
    albedo_ = at.albedo;
    origin_ = embree_.leaving_point(at.position, direction_, hit_.distance);
    // A point of the sphere around the normal's end is cosine-distributed.
    const glm::vec3 next = normal + 0.999f * even_direction(k_ * 7919u + surfaces_++ * 104729u + 1u);
    direction_ = glm::normalize(next);
    return true;
  }
  /// From where it goes on, and where to.
  glm::vec3 origin() const { return origin_; }
  glm::vec3 direction() const { return direction_; }
  const RayHit& hit() const { return hit_; }
  glm::vec3 position() const { return position_; }
  glm::vec3 albedo() const { return albedo_; }

 private:
  const EmbreeScene& embree_;
  glm::vec3 origin_, direction_, position_{0.0f}, albedo_{0.0f};
  std::uint32_t k_, surfaces_ = 0;
  RayHit hit_;
};

}  // namespace volgi
