#include "core/visibility/openness.h"

#include <fmt/format.h>

#include <cmath>
#include <glm/gtc/constants.hpp>
#include <limits>
#include <vector>

#include "core/log.h"
#include "core/surface.h"
#include "core/visibility/embree_scene.h"
#include "core/visibility/even_direction_internal.h"

namespace volgi {

namespace {

constexpr int MAX_SURFACES = 2;

bool leaves(const EmbreeScene& embree, glm::vec3 origin, std::uint32_t k) {
  constexpr float FAR = std::numeric_limits<float>::infinity();
  glm::vec3 direction = even_direction(k);
  for (int surfaces = 0; surfaces <= MAX_SURFACES; ++surfaces) {
    RayHit hit;
    if (!embree.intersect(origin, direction, FAR, k, hit)) return true;
    const Scene& scene = embree.scene();
    const SurfacePoint at = surface_point(scene, scene.meshes[hit.mesh], hit.triangle, hit.u, hit.v);
    const glm::vec3 normal =
        glm::dot(at.geometric_normal, direction) < 0.0f ? at.geometric_normal : -at.geometric_normal;
    origin = embree.leaving_point(at.position, direction, hit.distance);
    // A point of the sphere around the normal's end is cosine-distributed.
    const glm::vec3 next = normal + 0.999f * even_direction(k * 7919u + std::uint32_t(surfaces) * 104729u + 1u);
    direction = glm::normalize(next);
  }
  return false;
}

}  // namespace

double openness(const Scene& scene, std::span<const glm::vec3> from) {
  if (scene.triangle_count() == 0 || from.empty()) return 0.0;
  const EmbreeScene embree(scene);
  int left = 0;
  for (const glm::vec3 origin : from) {
    for (std::uint32_t k = 0; k < std::uint32_t(OPENNESS_RAYS); ++k) left += int(leaves(embree, origin, k));
  }
  return double(left) / (double(OPENNESS_RAYS) * double(from.size()));
}

void warn_of_open_scene(const Scene& scene, glm::vec3 eye) {
  if (is_quiet() || scene.sky) return;
  std::vector<glm::vec3> from{eye};
  for (const Light& light : scene.lights) {
    if (light.type != Light::Type::directional && from.size() < 8) from.push_back(light.position);
  }
  const double share = openness(scene, from);
  if (share < LEAST_OPENNESS) return;
  warn_once(
      fmt::format("{}: open, and there is no sky: {:.0f} % of the ways from camera and lamps end outside, where "
                  "light is lost and nothing is seen; --sky puts something there",
                  scene.name, 100.0 * share));
}

}  // namespace volgi
