#include "core/visibility/room_camera.h"

#include <algorithm>
#include <limits>

#include "core/surface.h"
#include "core/visibility/embree_scene.h"
#include "core/visibility/even_direction_internal.h"

namespace volgi {

namespace {

constexpr float FAR = std::numeric_limits<float>::infinity();
constexpr std::uint32_t RAYS = 96;
constexpr float CLOSED = 0.9f;      // share of directions that meet something
constexpr float TURNED_IN = 0.6f;   // share of what they meet that shows its front
constexpr float YFOV_RAD = 1.047f;  // 60 degrees: rooms are near
constexpr int WAYS = 16;            // level ones

/// How a place is, seen from one point.
struct Place {
  glm::vec3 at{0.0f};
  bool closed = false;
  bool lit = false;
  float mean_way_m = 0.0f;
  bool better_than(const Place& o) const {
    if (closed != o.closed) return closed;
    return lit != o.lit ? lit : mean_way_m > o.mean_way_m;
  }
};

bool sees_a_lamp(const EmbreeScene& embree, glm::vec3 at) {
  for (const Light& light : embree.scene().lights) {
    if (light.type == Light::Type::directional) continue;
    const glm::vec3 way = light.position - at;
    const float distance = glm::length(way);
    if (distance > 0.0f && !embree.occluded({at, way / distance, distance * 0.999f, 0, {}, {}})) return true;
  }
  return false;
}

Place look_around(const EmbreeScene& embree, glm::vec3 at) {
  Place place{.at = at};
  const Scene& scene = embree.scene();
  int met = 0, fronts = 0;
  for (std::uint32_t k = 0; k < RAYS; ++k) {
    const glm::vec3 direction = even_direction(k + 1);
    RayHit hit;
    if (!embree.intersect(at, direction, FAR, k, hit)) continue;
    const Mesh& mesh = scene.meshes[hit.mesh];
    const SurfacePoint p = surface_point(scene, mesh, hit.triangle, hit.u, hit.v);
    ++met;
    fronts += scene.materials[size_t(mesh.material)].double_sided || glm::dot(p.geometric_normal, direction) < 0.0f;
    place.lit = place.lit || p.emission != glm::vec3(0.0f);
    place.mean_way_m += hit.distance / float(RAYS);
  }
  place.closed = float(met) >= CLOSED * float(RAYS) && float(fronts) >= TURNED_IN * float(met);
  place.lit = place.lit || (place.closed && sees_a_lamp(embree, at));
  return place;
}

float way_m(const EmbreeScene& embree, glm::vec3 at, glm::vec3 direction, float most_m) {
  RayHit hit;
  return embree.intersect(at, direction, most_m, 0, hit) ? hit.distance : most_m;
}

Camera camera_in(const EmbreeScene& embree, glm::vec3 at, float diagonal_m) {
  glm::vec3 along(0.0f, 0.0f, -1.0f);
  float longest = -1.0f;
  for (int k = 0; k < WAYS; ++k) {
    const float angle = glm::two_pi<float>() * float(k) / float(WAYS);
    const glm::vec3 direction(std::sin(angle), 0.0f, -std::cos(angle));
    // What is behind counts too: the camera steps back.
    const float length = way_m(embree, at, direction, diagonal_m) + way_m(embree, at, -direction, diagonal_m);
    if (length <= longest * 1.001f) continue;
    longest = length;
    along = direction;
  }
  const float behind = way_m(embree, at, -along, diagonal_m);
  const glm::vec3 eye = at - along * (0.9f * behind);
  const Scene& scene = embree.scene();
  Camera camera = look_at_camera(eye, eye + along, YFOV_RAD, scene.bounds_min, scene.bounds_max);
  camera.name = "inside";
  return camera;
}

}  // namespace

std::optional<Camera> room_camera(const Scene& scene) {
  if (scene.triangle_count() == 0) return std::nullopt;
  const EmbreeScene embree(scene);
  constexpr glm::ivec3 LATTICE(7, 3, 7);
  Place best;
  for (int i = 0; i < LATTICE.x * LATTICE.y * LATTICE.z; ++i) {
    const glm::vec3 cell(i % LATTICE.x, i / LATTICE.x % LATTICE.y, i / (LATTICE.x * LATTICE.y));
    const glm::vec3 at = glm::mix(scene.bounds_min, scene.bounds_max, (cell + 0.5f) / glm::vec3(LATTICE));
    const Place place = look_around(embree, at);
    if (place.better_than(best)) best = place;
  }
  if (!best.closed) return std::nullopt;
  return camera_in(embree, best.at, glm::distance(scene.bounds_min, scene.bounds_max));
}

}  // namespace volgi
