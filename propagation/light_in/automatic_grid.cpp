#include "propagation/light_in/automatic_grid.h"

#include <algorithm>

#include "core/visibility/virtual_lights_cpu.h"
#include "propagation/light_in/reflected_flux_cpu.h"
#include "voxel/passages.h"

namespace volgi {

namespace {

constexpr int MOST = 256, STEP = 8;
constexpr size_t MOST_CELLS = size_t(1) << 20;
constexpr double SHORT_FLIGHTS = 0.03;  // of all power
constexpr int LIGHTS = 4096;
constexpr size_t RAYS = size_t(1) << 14;

/// First surfaces of all light, and how far it flies from there.
struct FirstSurfaces {
  std::vector<LitPoint> points;
  std::vector<Flight> flights;
};

FirstSurfaces first_surfaces(const Scene& scene) {
  const EmitterPoints emitters(scene);
  if (scene.lights.empty() && emitters.empty()) return {};
  const EmbreeScene embree(scene);
  const VirtualLightsCpu lights = virtual_lights_cpu(embree, emitters, LIGHTS, true);
  FirstSurfaces first{{}, flights(embree, {lights.lights, lights.reflected, {}, 0}, RAYS)};
  for (const shared::VirtualLight& l : lights.lights) {
    if (l.flux != glm::vec3(0.0f)) first.points.push_back({l.position, l.normal});
  }
  return first;
}

double short_flights(const std::vector<Flight>& flights, float cell_size_m) {
  double all = 0.0, near = 0.0;
  for (const Flight& f : flights) {
    all += double(f.power);
    if (f.length_m < cell_size_m) near += double(f.power);
  }
  return all > 0.0 ? near / all : 0.0;
}

}  // namespace

int automatic_grid_cells(const Scene& scene, const std::optional<GridBox>& box) {
  const auto grid_of = [&](int cells) { return make_grid(scene, cells, glm::vec3(0.0f), box); };
  const auto fits = [&](int cells) { return cells <= MOST && cell_count(grid_of(cells)) <= MOST_CELLS; };
  int cells = grid_cells_by_size(scene, box);
  const FirstSurfaces first = first_surfaces(scene);
  while (fits(cells + STEP) && short_flights(first.flights, grid_of(cells).cell_size_m) > SHORT_FLIGHTS) cells += STEP;
  return std::min(cells_that_keep_passages(scene, cells, MOST_CELLS, first.points, box), MOST);
}

}  // namespace volgi
