#include "core/visibility/reach.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

#include "core/surface.h"
#include "core/visibility/diffuse_path_internal.h"
#include "core/visibility/embree_scene.h"

namespace volgi {

namespace {

constexpr int MAX_SURFACES = 6;
constexpr double LEFT_OUT = 0.001;   // of all points, on each side
constexpr float STICKS_OUT = 0.05f;  // of the box's diagonal

struct Box {
  glm::vec3 min{std::numeric_limits<float>::infinity()};
  glm::vec3 max{-std::numeric_limits<float>::infinity()};
  void add(glm::vec3 p) {
    min = glm::min(min, p);
    max = glm::max(max, p);
  }
  bool empty() const { return min.x > max.x; }
  bool has(glm::vec3 p) const {
    return glm::all(glm::greaterThanEqual(p, min)) && glm::all(glm::lessThanEqual(p, max));
  }
};

/// Without what few have gone beyond, on each side of each axis: rays slip through cracks between triangles.
Box box_of_most(std::span<const glm::vec3> points) {
  Box box;
  if (points.empty()) return box;
  std::vector<float> along(points.size());
  const std::ptrdiff_t left_out = std::ptrdiff_t(LEFT_OUT * double(points.size()));
  for (int axis = 0; axis < 3; ++axis) {
    std::transform(points.begin(), points.end(), along.begin(), [&](glm::vec3 p) { return p[axis]; });
    std::nth_element(along.begin(), along.begin() + left_out, along.end());
    box.min[axis] = along[size_t(left_out)];
    std::nth_element(along.rbegin(), along.rbegin() + left_out, along.rend(), std::greater<>());
    box.max[axis] = along[along.size() - 1 - size_t(left_out)];
  }
  return box;
}

Box box_of(const Mesh& mesh, std::uint32_t triangle) {
  Box box;
  const glm::uvec3 corners = mesh.triangles[triangle];
  for (int k = 0; k < 3; ++k) box.add(mesh.positions[corners[k]]);
  return box;
}

}  // namespace

std::optional<ReachedBox> reached_box(const Scene& scene, std::span<const glm::vec3> from) {
  if (scene.triangle_count() == 0 || from.empty()) return {};
  const EmbreeScene embree(scene);
  std::vector<glm::vec3> points;
  std::vector<Box> met;
  for (const glm::vec3 origin : from) {
    for (std::uint32_t k = 0; k < std::uint32_t(REACH_RAYS); ++k) {
      DiffusePath path(embree, origin, k);
      for (int surfaces = 0; surfaces < MAX_SURFACES && path.step(); ++surfaces) {
        points.push_back(path.position());
        met.push_back(box_of(scene.meshes[path.hit().mesh], path.hit().triangle));
      }
    }
  }
  Box all = box_of_most(points);
  for (const Mesh& mesh : scene.meshes) {
    if (!scene.materials[size_t(mesh.material)].is_emissive()) continue;
    for (const glm::vec3& p : mesh.positions) all.add(p);
  }
  if (all.empty()) return {};
  const glm::vec3 margin(STICKS_OUT * glm::distance(all.min, all.max));
  const Box most = all, cut{all.min - margin, all.max + margin};
  for (size_t i = 0; i < met.size(); ++i) {
    if (!most.has(points[i])) continue;
    all.add(glm::clamp(met[i].min, cut.min, cut.max));
    all.add(glm::clamp(met[i].max, cut.min, cut.max));
  }
  return ReachedBox{all.min, all.max};
}

std::vector<glm::vec3> places_of_light(const Scene& scene, glm::vec3 eye) {
  std::vector<glm::vec3> places{eye};
  for (const Light& light : scene.lights) {
    if (light.type != Light::Type::directional && places.size() < 8) places.push_back(light.position);
  }
  return places;
}

}  // namespace volgi
