#include "propagation/light_in/automatic_grid.h"

#include <algorithm>

#include "core/emitter_points.h"
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
  double area_m2 = 0.0;  // SceneFacts::lit_area_m2
  int lamps = 0;         // SceneFacts::lamps
};

/// (sum of power)^2 over the sum of power^2 per area: of N alike lights the sum of their areas.
double lit_area(const std::vector<shared::VirtualLight>& lights) {
  double power = 0.0, squares_per_area = 0.0;
  for (const shared::VirtualLight& l : lights) {
    const double p = double(l.flux.x + l.flux.y + l.flux.z);
    if (!(p > 0.0) || !(l.area_m2 > 0.0f)) continue;
    power += p;
    squares_per_area += p * p / double(l.area_m2);
  }
  return squares_per_area > 0.0 ? power * power / squares_per_area : 0.0;
}

/// Length [m] under which that share of the power flies; 0 where nothing does.
float shortest(std::vector<Flight> flights, double share) {
  std::sort(flights.begin(), flights.end(), [](const Flight& a, const Flight& b) { return a.length_m < b.length_m; });
  double all = 0.0, sum = 0.0;
  for (const Flight& f : flights) all += double(f.power);
  for (const Flight& f : flights) {
    sum += double(f.power);
    if (sum >= share * all) return f.length_m;
  }
  return 0.0f;
}

FirstSurfaces first_surfaces(const Scene& scene) {
  const EmitterPoints emitters(scene);
  if (scene.lights.empty() && emitters.empty()) return {};
  const EmbreeScene embree(scene);
  const VirtualLightsCpu lights = virtual_lights_cpu(embree, emitters, LIGHTS, true);
  FirstSurfaces first{{},
                      flights(embree, {lights.lights, lights.reflected, {}, 0}, RAYS),
                      lit_area(lights.lights),
                      int(scene.lights.size()) + (emitters.empty() ? 0 : 1)};
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

int cells_for(const Scene& scene, const FirstSurfaces& first, const std::optional<GridBox>& box) {
  const auto grid_of = [&](int cells) { return make_grid(scene, cells, glm::vec3(0.0f), box); };
  const auto fits = [&](int cells) { return cells <= MOST && cell_count(grid_of(cells)) <= MOST_CELLS; };
  int cells = grid_cells_by_size(scene, box);
  while (fits(cells + STEP) && short_flights(first.flights, grid_of(cells).cell_size_m) > SHORT_FLIGHTS) cells += STEP;
  return std::min(cells_that_keep_passages(scene, cells, MOST_CELLS, first.points, box), MOST);
}

}  // namespace

SceneFacts scene_facts(const Scene& scene, const std::optional<GridBox>& box, std::optional<int> cells) {
  const FirstSurfaces first = first_surfaces(scene);
  const glm::vec3 edges = box ? box->max - box->min : scene.bounds_max - scene.bounds_min;
  SceneFacts facts;
  facts.edge_m = std::max({edges.x, edges.y, edges.z});
  facts.cells = cells ? *cells : cells_for(scene, first, box);
  facts.feature_m = shortest(first.flights, SHORT_FLIGHTS);
  facts.flight_m = shortest(first.flights, 0.5);
  facts.lit_area_m2 = float(first.area_m2);
  facts.lamps = first.lamps;
  return facts;
}

int automatic_grid_cells(const Scene& scene, const std::optional<GridBox>& box) {
  return scene_facts(scene, box).cells;
}

}  // namespace volgi
