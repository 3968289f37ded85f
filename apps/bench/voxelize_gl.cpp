#include "apps/bench/voxelize_gl.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstring>
#include <map>

#include "apps/bench/timing.h"
#include "core/gl/context.h"
#include "voxel/sliced_voxelization.h"

namespace volgi::app {

namespace {

using Sides = std::map<std::pair<int, int>, shared::Side>;  // by cell and face

struct Voxelized {
  double ms;
  Sides sides;
};

Voxelized voxelized(const gl::SceneBuffers& buffers, const Grid& grid, VoxelizationOptions options, int repeats) {
  gl::PassTimer timer(gl::current_is_software(), false);
  SlicedVoxelization voxelization(grid, options);
  std::vector<double> times;
  constexpr int kWarmUp = 6;  // of interleaved ones, as many as make a full one
  for (int run = -kWarmUp; run < repeats; ++run) {
    glFinish();
    const double ms = time_ms([&] {
      voxelization.run(buffers, timer);
      glFinish();
    });
    if (run >= 0) times.push_back(ms);
  }
  Voxelized result{median(times), {}};
  for (const shared::Side& side : voxelization.voxels().download_sides())
    result.sides.emplace(std::pair(side.cell, side.face), side);
  return result;
}

size_t missing(const Sides& from, const Sides& in) {
  return size_t(std::count_if(from.begin(), from.end(), [&](const auto& s) { return !in.contains(s.first); }));
}

size_t differing(const Sides& a, const Sides& b) {
  return size_t(std::count_if(a.begin(), a.end(), [&](const auto& s) {
    const auto other = b.find(s.first);
    return other != b.end() && std::memcmp(&s.second, &other->second, sizeof s.second) != 0;
  }));
}

}  // namespace

nlohmann::json bench_voxelize_gl(const Scene& scene, int grid_cells, int repeats) {
  const Grid grid = make_grid(scene, grid_cells);
  const gl::SceneBuffers buffers(scene);
  nlohmann::json methods = nlohmann::json::array();
  const std::pair<const char*, VoxelizationOptions> all[] = {
      {"three slices", {}},
      {"single pass", {.method = VoxelizationMethod::single_pass}},
      {"one slice a frame", {.interleave = true}}};
  Sides slices;
  for (const auto& [name, options] : all) {
    Voxelized v = voxelized(buffers, grid, options, repeats);
    if (methods.empty()) slices = v.sides;
    methods.push_back({{"name", name},
                       {"ms", v.ms},
                       {"sides", v.sides.size()},
                       {"holes", missing(slices, v.sides)},
                       {"extra", missing(v.sides, slices)},
                       {"differing", differing(slices, v.sides)}});
  }
  return {{"scene", scene.name},
          {"triangles", scene.triangle_count()},
          {"grid", {grid.cells.x, grid.cells.y, grid.cells.z}},
          {"repeats", repeats},
          {"methods", methods}};
}

std::string voxelize_gl_table(const nlohmann::json& r) {
  std::string text = fmt::format("{} on the GPU, {} triangles, {} cells:\n", r["scene"].get<std::string>(),
                                 r["triangles"].get<size_t>(), fmt::join(r["grid"].get<std::vector<int>>(), "x"));
  for (const auto& m : r["methods"]) {
    text += fmt::format("  {:<17} {:7.1f} ms, {} sides; against three slices {} holes, {} more, {} differ\n",
                        m["name"].get<std::string>(), m["ms"].get<double>(), m["sides"].get<size_t>(),
                        m["holes"].get<size_t>(), m["extra"].get<size_t>(), m["differing"].get<size_t>());
  }
  return text;
}

}  // namespace volgi::app
