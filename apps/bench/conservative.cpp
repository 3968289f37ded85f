#include "apps/bench/conservative.h"

#include <tbb/global_control.h>
#include <tbb/info.h>

#include <algorithm>
#include <vector>

#include "apps/bench/timing.h"
#include "propagation/transport_conservative_cpu.h"

namespace volgi::app {

namespace {

using Powers = std::vector<glm::vec4>;

/// Closed box of cells^3, grey walls one side a face.
VoxelGrid closed_box(int cells) {
  Grid grid{};
  grid.cells = glm::ivec3(cells);
  grid.cell_size_m = 2.0f / float(cells);
  grid.origin = glm::vec3(-1.0f);
  std::vector<shared::Side> sides;
  for (int i = 0; i < int(cell_count(grid)); ++i) {
    const glm::ivec3 cell = shared::cell_coord(grid, i);
    for (int face = 0; face < 6; ++face) {
      if (shared::cell_inside(grid, cell + shared::face_step(face))) continue;
      shared::Side side{};
      side.normal = -glm::vec3(shared::face_step(face));
      side.coverage = 1.0f;
      side.albedo = glm::vec3(0.5f);
      side.area_m2 = side.face_m2 = grid.cell_size_m * grid.cell_size_m;
      side.cell = i;
      side.face = face;
      sides.push_back(side);
    }
  }
  return VoxelGrid(grid, std::move(sides));
}

/// Shares of all leaves, rows of 8 cells and cells that hold light: what no sparse code of that grain can do without.
glm::dvec3 lit_shares(const ConservativeTransportCpu& transport) {
  size_t rows = 0, cells = 0;
  for (const int number : transport.lobes().leaves()) {
    const float* leaf = transport.lobes().leaf(number);
    for (int row = 0; row < kLobeRows; ++row) {
      const size_t before = cells;
      for (int i = 8 * row; i < 8 * row + 8; ++i) {
        const bool lit =
            leaf[lobe_block(0, 0) + i] > 0.0f || leaf[lobe_block(0, 1) + i] > 0.0f || leaf[lobe_block(0, 2) + i] > 0.0f;
        cells += lit ? 1 : 0;
      }
      rows += cells > before ? 1 : 0;
    }
  }
  const auto all = double(transport.numbers().count());
  return {double(transport.lobes().leaves().size()) / all, double(rows) / (all * kLobeRows),
          double(cells) / (all * kLobeLeafCells)};
}

}  // namespace

nlohmann::json bench_conservative(int cells, int iterations, int repeats) {
  const VoxelGrid voxels = closed_box(cells);
  ConservativeTransportCpu transport(voxels, 1);
  const Powers sent(voxels.side_count(), glm::vec4(1.0f, 0.8f, 0.6f, 0.0f));
  Powers received(voxels.side_count(), glm::vec4(0.0f));
  transport.set_dense(true);
  transport.begin(sent);
  for (int i = 0; i < 4; ++i) transport.pass(received, true);  // both states are touched
  const size_t state = cell_count(voxels.grid()) * 12 * sizeof(float);
  const size_t read = state + received.size() * sizeof(glm::vec4);
  Copying copying(read);
  copying.run();
  // In turn: on a shared machine memory is slow for seconds at a time.
  std::vector<double> passes, copies, ratios;
  for (int i = 0; i < std::max(repeats, 5); ++i) {
    const auto of_one = [&](const auto& once) {
      return time_ms([&] {
               for (int k = 0; k < iterations; ++k) once();
             }) /
             iterations;
    };
    passes.push_back(of_one([&] { transport.pass(received, true); }));
    copies.push_back(of_one([&] { copying.run(); }));
    ratios.push_back(passes.back() / copies.back());
  }
  return {{"cells", cells},
          {"threads", tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism)},
          {"iterations", iterations},
          {"ms_per_iteration", median(passes)},
          {"copy_ms", median(copies)},
          {"ratio", median(ratios)},
          {"ratio_range", {*std::ranges::min_element(ratios), *std::ranges::max_element(ratios)}},
          {"bytes", 2 * read}};
}

nlohmann::json bench_sparse(const VoxelGrid& voxels, std::span<const glm::vec4> sent, int iterations, int repeats) {
  Powers received(sent.size(), glm::vec4(0.0f));
  ConservativeTransportCpu transport(voxels, 1);
  ConservativeTransportCpu dense_transport(voxels, 1);
  dense_transport.set_dense(true);
  const auto ms_per_pass = [&](ConservativeTransportCpu& t) {
    t.begin(sent);
    return time_ms([&] {
             for (int pass = 0; pass < iterations; ++pass) t.pass(received, true);
           }) /
           iterations;
  };
  std::vector<double> dense, sparse, speedups;
  for (int i = -1; i < std::max(repeats, 5); ++i) {
    const double d = ms_per_pass(dense_transport), s = ms_per_pass(transport);
    if (i < 0) continue;  // memory is fetched in the first
    dense.push_back(d);
    sparse.push_back(s);
    speedups.push_back(d / s);
  }
  const size_t lit_leaves = transport.lobes().leaves().size();
  glm::dvec3 shares(0.0);
  transport.begin(sent);
  for (int pass = 0; pass < iterations; ++pass) {
    transport.pass(received, true);
    shares += lit_shares(transport) / double(iterations);
  }
  return {{"sparse_ms", median(sparse)},
          {"dense_ms", median(dense)},
          {"lit_shares", {{"leaves", shares[0]}, {"rows", shares[1]}, {"cells", shares[2]}}},
          {"speedup", median(speedups)},
          {"speedup_range", {*std::ranges::min_element(speedups), *std::ranges::max_element(speedups)}},
          {"leaves", transport.numbers().count()},
          {"lit_leaves", lit_leaves},
          {"iterations", iterations}};
}

}  // namespace volgi::app
