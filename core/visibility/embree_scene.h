#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <memory>

#include "core/scene.h"

namespace volgi {

/// A triangle, by index into Scene::meshes and Mesh::triangles; none by default.
struct TriangleIndex {
  static constexpr std::uint32_t none = 0xffffffffu;
  std::uint32_t mesh = none;
  std::uint32_t triangle = none;
  bool operator==(const TriangleIndex&) const = default;
};

/// `direction` is unit. A ray that starts or ends on a known triangle names it in `from` or `to`: that triangle (and
/// what coincides with it at the start) cannot block the ray, and no distance need be guessed to step off it.
struct Ray {
  glm::vec3 origin{0.0f};
  glm::vec3 direction{0.0f, 0.0f, -1.0f};
  float max_distance = std::numeric_limits<float>::infinity();  // [m]
  std::uint32_t alpha_seed = 0;
  TriangleIndex from;
  TriangleIndex to;
};

/// Where a ray met a triangle.
struct RayHit {
  float distance = 0.0f;
  std::uint32_t mesh = 0;  // index into Scene::meshes
  std::uint32_t triangle = 0;
  float u = 0.0f, v = 0.0f;  // barycentric
  glm::vec3 tint{1.0f};      // of light along the ray: what the glass that it passed leaves, also where it met nothing
  TriangleIndex index() const { return {mesh, triangle}; }
};

/// Embree's acceleration structure over a scene (which must outlive it). Alpha: MASK is resolved in the traversal,
/// BLEND and glass let a ray pass with probability 1 - alpha by hashing `alpha_seed` with the triangle. Thread-safe
/// after construction; built on one thread, so that no answer depends on how many there are.
/// @throws Error(over_limit) when memory runs out while building.
class EmbreeScene {
 public:
  explicit EmbreeScene(const Scene& scene);
  ~EmbreeScene();
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;

  bool intersect(const Ray& ray, RayHit& hit) const;
  bool occluded(const Ray& ray) const;
  /// Of light along the ray: 0 where it is occluded, else the tint of the glass that it passes, 1 without any.
  glm::vec3 passed(const Ray& ray) const;

  /// Rays that may start on a surface nobody knows: the first 1e-5 of the scene's size are skipped.
  bool intersect(glm::vec3 origin, glm::vec3 direction, float max_distance, std::uint32_t alpha_seed,
                 RayHit& hit) const;
  bool occluded(glm::vec3 origin, glm::vec3 direction, float max_distance, std::uint32_t alpha_seed) const;

  /// Where rays leave a surface that was met at `position` along `direction`: a few roundings back on the way that the
  /// ray came. That way is known to be free, so the point lies on the right side of every other surface too, also in
  /// corners and on walls without thickness, where an offset along the normal may already be outside.
  glm::vec3 leaving_point(glm::vec3 position, glm::vec3 direction, float distance) const;

  const Scene& scene() const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace volgi
