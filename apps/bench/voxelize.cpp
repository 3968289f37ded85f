#include "apps/bench/voxelize.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <openvdb/tools/MeshToVolume.h>
#include <tbb/info.h>

#include "apps/bench/timing.h"
#include "voxel/voxelize_cpu.h"

namespace volgi::app {

namespace {

/// The scene as meshToVolume takes it: points in index space.
struct IndexMesh {
  std::vector<openvdb::Vec3s> points;
  std::vector<openvdb::Vec3I> triangles;

  IndexMesh(const Scene& scene, const Grid& grid) {
    for (const Mesh& mesh : scene.meshes) {
      const auto first = std::uint32_t(points.size());
      for (const glm::vec3& position : mesh.positions) {
        const glm::vec3 index = shared::cell_from_world(grid, position) - 0.5f;
        points.emplace_back(index.x, index.y, index.z);
      }
      for (const glm::uvec3& t : mesh.triangles) triangles.emplace_back(first + t.x, first + t.y, first + t.z);
    }
  }
};

}  // namespace

nlohmann::json bench_voxelize(const Scene& scene, int grid_cells, int repeats) {
  const Grid grid = make_grid(scene, grid_cells);
  // Made once for a scene, as VolumeCpu does: they do not change where vertices move. meshToVolume has no materials.
  const Mipmaps mipmaps = voxelization_mipmaps(scene);
  const IndexMesh mesh(scene, grid);
  const auto transform = world_from_index(grid, scene.world_origin);
  constexpr float kBand = 1.0f;  // cells
  size_t sides = 0;
  openvdb::Index64 cells = 0;
  std::vector<double> sides_ms, cells_ms, all_ms, other_ms;
  for (int run = 0; run <= repeats; ++run) {
    const double s = time_ms([&] { sides = voxelize_cpu(scene, grid, mipmaps).side_count(); });
    const double c = time_ms([&] { cells = cell_volumes_cpu(scene, grid, mipmaps).occupancy->activeVoxelCount(); });
    const double a = time_ms([&] { voxelize_all_cpu(scene, grid, mipmaps); });
    const double o = time_ms([&] {
      const openvdb::tools::QuadAndTriangleDataAdapter<openvdb::Vec3s, openvdb::Vec3I> adapter(mesh.points,
                                                                                               mesh.triangles);
      openvdb::tools::meshToVolume<openvdb::FloatGrid>(adapter, *transform, kBand, kBand);
    });
    if (run == 0) continue;
    sides_ms.push_back(s);
    cells_ms.push_back(c);
    all_ms.push_back(a);
    other_ms.push_back(o);
  }
  return {{"scene", scene.name},
          {"triangles", scene.triangle_count()},
          {"threads", tbb::info::default_concurrency()},
          {"grid", {grid.cells.x, grid.cells.y, grid.cells.z}},
          {"sides", sides},
          {"cells", cells},
          {"repeats", repeats},
          {"sides_ms", median(sides_ms)},
          {"cells_ms", median(cells_ms)},
          {"all_ms", median(all_ms)},
          {"mesh_to_volume_ms", median(other_ms)},
          {"mesh_to_volume_over_cells", median(other_ms) / median(cells_ms)},
          {"mesh_to_volume_over_sides", median(other_ms) / median(sides_ms)},
          {"mesh_to_volume_over_all", median(other_ms) / median(all_ms)}};
}

std::string voxelize_table(const nlohmann::json& r) {
  std::string text = fmt::format("{}, {} triangles, {} cells, meshToVolume {:.1f} ms:\n", r["scene"].get<std::string>(),
                                 r["triangles"].get<size_t>(), fmt::join(r["grid"].get<std::vector<int>>(), "x"),
                                 r["mesh_to_volume_ms"].get<double>());
  const auto row = [&](const char* name, const char* what) {
    text +=
        fmt::format("  {:<6} {:7.1f} ms, {:5.1f} times as fast: {}\n", name, r[std::string(name) + "_ms"].get<double>(),
                    r[std::string("mesh_to_volume_over_") + name].get<double>(), what);
  };
  row("cells", "occupancy, normal, albedo and emission of each cell, as OpenVDB grids (volgi export)");
  row("sides", "blocked faces with their sides: coverage, area, normal, albedo, emission (transport)");
  row("all", "both");
  return text;
}

}  // namespace volgi::app
