#include "screen/sources/textured_area/area_lights.h"

#include "core/luminance.h"

namespace volgi::screen {

using Sampling = AreaLightOptions::Sampling;

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
