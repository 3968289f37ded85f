#include "screen/sources/textured_area/area_lights.h"

#include <algorithm>

#include "core/luminance.h"

namespace volgi::screen {

using Sampling = AreaLightOptions::Sampling;

namespace {

/// Along the curve of Morton's numbers through their places, 1024 cells on each edge of the box around all: four that
/// follow on one another are neighbours, two by two on a grid.
void order_by_place(std::vector<EmitterPoint>& points) {
  if (points.empty()) return;
  glm::vec3 least = points.front().position, most = least;
  for (const EmitterPoint& p : points) {
    least = glm::min(least, p.position);
    most = glm::max(most, p.position);
  }
  const glm::vec3 edge = most - least;
  const float per_m = 1023.0f / std::max({edge.x, edge.y, edge.z, 1e-30f});
  const auto spread = [](std::uint32_t v) {  // two zeros behind each of ten bits
    v = (v | v << 16) & 0x030000ffu;
    v = (v | v << 8) & 0x0300f00fu;
    v = (v | v << 4) & 0x030c30c3u;
    return (v | v << 2) & 0x09249249u;
  };
  const auto place = [&](const EmitterPoint& p) {
    const glm::uvec3 cell((p.position - least) * per_m);
    return spread(cell.x) | spread(cell.y) << 1 | spread(cell.z) << 2;
  };
  std::stable_sort(points.begin(), points.end(),
                   [&](const EmitterPoint& a, const EmitterPoint& b) { return place(a) < place(b); });
}

}  // namespace

AreaLights::AreaLights(const Scene& scene, const AreaLightOptions& options)
    : scene_(scene), options_(options), emitters_(scene) {}

void AreaLights::scene_moved() {
  emitters_ = EmitterPoints(scene_);
  sample_ = -1;
}

void AreaLights::run(gl::PassTimer& timer, int sample) {
  const bool on_grid = options_.sampling == Sampling::grid;
  if (sample_ == sample || (on_grid && sample_ >= 0)) return;
  const auto scope = timer.scope(name);
  sample_ = sample;
  std::vector<EmitterPoint> points = on_grid ? emitters_.grid_points(options_.lights) : std::vector<EmitterPoint>();
  // A grid that has to have more, as one of a ball of many triangles, is none.
  const bool by_power = !on_grid || int(points.size()) > options_.lights;
  if (by_power) points = emitters_.points(options_.lights, sample);
  order_by_place(points);
  std::vector<shared::VirtualLight> lights;
  lights.reserve(points.size());
  double area = 0.0;
  for (const EmitterPoint& p : points) {
    lights.push_back({p.position, p.area_m2, p.normal, VIRTUAL_LIGHT_EMITTED, p.flux, -1});
    area += double(p.area_m2);
  }
  count_ = int(lights.size());
  const double watts = luminance(emitters_.flux());
  lights_per_watt_ = by_power && watts > 0.0 ? float(count_ / watts) : 0.0f;
  lights_per_m2_ = !by_power && area > 0.0 ? float(count_ / area) : 0.0f;
  if (lights.empty()) lights.emplace_back();
  gl::put(buffer_, lights);
}

std::vector<shared::VirtualLight> AreaLights::download() const {
  return buffer_.download<shared::VirtualLight>(size_t(count_));
}

}  // namespace volgi::screen
