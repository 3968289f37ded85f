#include "core/visibility/openness.h"

#include <fmt/format.h>

#include <cmath>
#include <glm/gtc/constants.hpp>
#include <vector>

#include "core/log.h"
#include "core/visibility/diffuse_path_internal.h"
#include "core/visibility/embree_scene.h"
#include "core/visibility/reach.h"

namespace volgi {

namespace {

constexpr int MAX_SURFACES = 2;

bool leaves(const EmbreeScene& embree, glm::vec3 origin, std::uint32_t k) {
  DiffusePath path(embree, origin, k);
  for (int surfaces = 0; surfaces <= MAX_SURFACES; ++surfaces) {
    if (!path.step()) return true;
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
  const double share = openness(scene, places_of_light(scene, eye));
  if (share < LEAST_OPENNESS) return;
  warn_once(
      fmt::format("{}: open, and there is no sky: {:.0f} % of the ways from camera and lamps end outside, where "
                  "light is lost and nothing is seen; --sky puts something there",
                  scene.name, 100.0 * share));
}

}  // namespace volgi
