#include "apps/bench/cascades.h"

#include <fmt/format.h>
#include <tbb/info.h>

#include <cmath>
#include <vector>

#include "apps/bench/timing.h"
#include "core/surface.h"
#include "core/visibility/embree_scene.h"
#include "propagation/light_in/direct_light_cpu.h"
#include "propagation/pixel_irradiance_cpu.h"
#include "propagation/volume_cpu.h"

namespace volgi::app {

namespace {

struct Seen {
  glm::vec3 position, normal;
};

/// What the scene's camera sees nearby.
std::vector<Seen> seen_nearby(const Scene& scene, const CascadesBenchOptions& options) {
  const EmbreeScene embree(scene);
  const Camera& camera = scene.cameras.front();
  std::vector<Seen> seen;
  for (int y = 0; y < options.size; ++y) {
    for (int x = 0; x < options.size; ++x) {
      const CameraRay ray = camera_ray(camera, {float(x) + 0.5f, float(y) + 0.5f}, glm::ivec2(options.size));
      RayHit hit;
      if (!embree.intersect(ray.origin, ray.direction, options.near_m, 0, hit)) continue;
      const SurfacePoint at = surface_point(scene, scene.meshes[hit.mesh], hit.triangle, hit.u, hit.v);
      const bool front = glm::dot(at.geometric_normal, ray.direction) < 0.0f;
      seen.push_back({at.position, front ? at.geometric_normal : -at.geometric_normal});
    }
  }
  return seen;
}

struct Answer {
  std::vector<glm::dvec3> irradiance;  // by what is seen
  std::vector<glm::ivec3> cells;
  size_t sides = 0, bytes = 0;
  double ms = 0.0, light_in_ms = 0.0;
};

Answer answer(const Scene& scene, const VolumeOptions& options, const std::vector<Seen>& seen) {
  Answer a;
  VolumeCpu volume(scene, options);
  const double before = processor_ms();
  volume.voxelize();
  const double voxelized = processor_ms();
  volume.light_in(direct_light(scene, volume));
  a.light_in_ms = processor_ms() - voxelized;
  volume.propagate();
  volume.irradiate();
  a.ms = processor_ms() - before - a.light_in_ms;
  a.bytes = volume.bytes();
  a.sides = volume.sides().count();
  for (const Grid& grid : volume.cascade().grids) a.cells.push_back(grid.cells);
  const glm::vec4 viewer(glm::vec3(scene.cameras.front().world_from_camera[3]), 1.0f);
  for (const Seen& s : seen) {
    const PixelIrradiance e =
        irradiance_at_pixel(volume.sides(), volume.irradiance_of_levels(), s.position, s.normal, viewer);
    a.irradiance.push_back(glm::dvec3(e.direct) + glm::dvec3(e.indirect));
  }
  return a;
}

nlohmann::json figures(const Answer& a, const Answer& one) {
  glm::dvec3 squares(0.0), sum(0.0), truth(0.0);
  for (size_t i = 0; i < a.irradiance.size(); ++i) {
    const glm::dvec3 difference = a.irradiance[i] - one.irradiance[i];
    squares += difference * difference;
    sum += a.irradiance[i];
    truth += one.irradiance[i];
  }
  const auto count = double(a.irradiance.size());
  const glm::dvec3 rmse = glm::sqrt(squares / count) / (truth / count);
  nlohmann::json cells;
  for (const glm::ivec3& c : a.cells) cells.push_back({c.x, c.y, c.z});
  return {{"cells", cells},
          {"sides", a.sides},
          {"ms", a.ms},
          {"light_in_ms", a.light_in_ms},
          {"bytes", a.bytes},
          {"rmse_percent", 100.0 * (rmse.x + rmse.y + rmse.z) / 3.0},
          {"energy", (sum.x + sum.y + sum.z) / (truth.x + truth.y + truth.z)},
          {"ms_share", a.ms / one.ms},
          {"bytes_share", double(a.bytes) / double(one.bytes)}};
}

std::string row(const std::string& name, const nlohmann::json& r) {
  std::string cells;
  for (const auto& c : r["cells"])
    cells += fmt::format("{}{}x{}x{}", cells.empty() ? "" : " + ", c[0].get<int>(), c[1].get<int>(), c[2].get<int>());
  return fmt::format("| {} | {} | {} | {:.1f} | {:.3f} | {:.1f} | {:.1f} | {:.3f} | {:.2f} | {:.4f} |\n", name, cells,
                     r["sides"].get<size_t>(), r["ms"].get<double>() / 1e3, r["ms_share"].get<double>(),
                     r["light_in_ms"].get<double>() / 1e3, double(r["bytes"].get<size_t>()) / 1048576.0,
                     r["bytes_share"].get<double>(), r["rmse_percent"].get<double>(), r["energy"].get<double>());
}

}  // namespace

nlohmann::json bench_cascades(Scene scene, const CascadesBenchOptions& options) {
  if (!scene.sky) scene.sky = std::make_shared<Sky>(glm::vec3(0.2f, 0.25f, 0.35f));
  const std::vector<Seen> seen = seen_nearby(scene, options);
  VolumeOptions volume;
  volume.grid_cells = options.fine_cells;
  const Answer one = answer(scene, volume, seen);
  nlohmann::json result{{"scene", scene.name},
                        {"fine_cells", options.fine_cells},
                        {"near_m", options.near_m},
                        {"threads", tbb::info::default_concurrency()},
                        {"one", figures(one, one)}};
  volume.cascade.around = glm::vec3(scene.cameras.front().world_from_camera[3]);
  for (const auto& [levels, ratio] : {std::pair(3, 4), std::pair(3, 2), std::pair(4, 2)}) {
    const int times = int(std::lround(std::pow(ratio, levels - 1)));
    if (options.fine_cells % times != 0) continue;
    volume.cascade.levels = levels;
    volume.cascade.ratio = ratio;
    volume.grid_cells = options.fine_cells / times;
    nlohmann::json r = figures(answer(scene, volume, seen), one);
    r["levels"] = levels;
    r["ratio"] = ratio;
    result["cascades"].push_back(std::move(r));
  }
  return result;
}

std::string cascades_table(const nlohmann::json& r) {
  std::string table = fmt::format(
      "{}: nested grids around the camera against one grid of {} cells, surfaces within {:g} m\n"
      "| grids | cells | sides | s | of one | rays, s | MiB | of one | rmse % | energy |\n"
      "|---|---|---|---|---|---|---|---|---|---|\n",
      r["scene"].get<std::string>(), r["fine_cells"].get<int>(), r["near_m"].get<double>());
  table += row("one", r["one"]);
  for (const auto& c : r["cascades"])
    table += row(fmt::format("{}, each {} times as coarse", c["levels"].get<int>(), c["ratio"].get<int>()), c);
  return table;
}

}  // namespace volgi::app
