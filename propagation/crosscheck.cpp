#include "propagation/crosscheck.h"

#include <fmt/format.h>
#include <openvdb/openvdb.h>

#include <algorithm>
#include <cmath>

#include "core/gl/context.h"
#include "core/surface.h"
#include "core/visibility/light_flux.h"
#include "propagation/bounces_cpu.h"
#include "propagation/bounces_gl.h"
#include "propagation/pulse_volume_cpu.h"
#include "propagation/pulse_volume_gl.h"
#include "propagation/side_irradiance_gl.h"
#include "propagation/transport_conservative_gl.h"
#include "propagation/transport_ordinates_gl.h"
#include "voxel/cell_volumes_gl.h"
#include "voxel/emitter_pieces.h"
#include "voxel/sliced_voxelization.h"
#include "voxel/voxelize_cpu.h"

namespace volgi {

namespace {

using shared::Side;

// docs/hard-cases.md, "twin".
constexpr double kCellsThatMayDiffer = 1e-3;
constexpr double kAttributeLimit = 1e-3;
constexpr double kPowerLimit = 1e-4;
constexpr int kLightTexels = 512;  // of a spot's layer; both twins get the same samples

/// Collects the differences of one stage.
class Differences {
 public:
  void add(double difference, int cell) {
    // NaN must not pass as small.
    if (!(difference <= largest_)) {
      largest_ = std::isnan(difference) ? HUGE_VAL : difference;
      worst_ = cell;
    }
    all_.push_back(std::isnan(difference) ? HUGE_VAL : difference);
  }
  CrosscheckRow row(const Grid& grid, std::string stage, std::string scale, double limit) {
    CrosscheckRow r{std::move(stage),
                    std::move(scale),
                    all_.size(),
                    std::max(largest_, 0.0),
                    0.0,
                    shared::cell_coord(grid, worst_),
                    limit};
    if (!all_.empty()) {
      const auto rank = all_.begin() + std::ptrdiff_t(double(all_.size() - 1) * 0.999);
      std::nth_element(all_.begin(), rank, all_.end());
      r.percentile_999 = *rank;
    }
    return r;
  }

 private:
  std::vector<double> all_;
  double largest_ = -1.0;
  int worst_ = 0;
};

double largest_component(glm::vec3 v) { return double(std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)})); }

/// Sides that both have.
template <typename F>
void for_common_sides(const VoxelGrid& a, const VoxelGrid& b, const F& use) {
  for (const Side& side : a.sides()) {
    const glm::uvec2 other = b.cell_sides(shared::cell_coord(b.grid(), side.cell));
    if (shared::has_side(other, side.face)) use(side, b.sides()[shared::side_index(other, side.face)]);
  }
}

/// Cells whose blocked faces differ, over the cells that have some in either.
CrosscheckRow compare_blocked_faces(const VoxelGrid& gpu, const VoxelGrid& cpu) {
  const Grid& grid = gpu.grid();
  size_t occupied = 0, different = 0;
  glm::ivec3 first_different(0);
  for (int i = 0; i < int(cell_count(grid)); ++i) {
    const glm::ivec3 cell = shared::cell_coord(grid, i);
    const std::uint32_t a = gpu.cell_sides(cell).y, b = cpu.cell_sides(cell).y;
    if (((a | b) & 63u) == 0) continue;
    ++occupied;
    if (a == b) continue;
    if (different++ == 0) first_different = cell;
  }
  const double share = double(different) / double(std::max<size_t>(occupied, 1));
  return {"blocked faces",    "share of occupied cells that differ", occupied, share, share, first_different,
          kCellsThatMayDiffer};
}

template <typename F>
CrosscheckRow compare_sides(const VoxelGrid& gpu, const VoxelGrid& cpu, const char* stage, const char* scale,
                            const F& difference) {
  Differences d;
  for_common_sides(gpu, cpu, [&](const Side& a, const Side& b) { d.add(difference(a, b), a.cell); });
  return d.row(gpu.grid(), stage, scale, kAttributeLimit);
}

void compare_voxels(const VoxelGrid& gpu, const VoxelGrid& cpu, std::vector<CrosscheckRow>& rows) {
  rows.push_back(compare_blocked_faces(gpu, cpu));
  rows.push_back(compare_sides(gpu, cpu, "coverage", "1", [](const Side& a, const Side& b) {
    return std::abs(double(a.coverage) - double(b.coverage));
  }));
  rows.push_back(compare_sides(gpu, cpu, "side normal", "1",
                               [](const Side& a, const Side& b) { return largest_component(a.normal - b.normal); }));
  rows.push_back(compare_sides(gpu, cpu, "side albedo", "1",
                               [](const Side& a, const Side& b) { return largest_component(a.albedo - b.albedo); }));
  const double h2 = double(gpu.grid().cell_size_m) * double(gpu.grid().cell_size_m);
  rows.push_back(compare_sides(gpu, cpu, "side area", "h^2", [&](const Side& a, const Side& b) {
    return std::abs(double(a.area_m2) - double(b.area_m2)) / h2;
  }));
  rows.back().ties = true;
  double brightest = 1e-30;
  for (const Side& s : gpu.sides()) brightest = std::max(brightest, largest_component(s.radiosity));
  rows.push_back(compare_sides(gpu, cpu, "side emission", "largest", [&](const Side& a, const Side& b) {
    return largest_component(a.radiosity - b.radiosity) / brightest;
  }));
}

/// Per-side vectors of the same voxels, relative to the largest component.
CrosscheckRow compare_power(const VoxelGrid& voxels, const std::vector<glm::vec4>& gpu,
                            const std::vector<glm::vec4>& cpu, std::string stage, double limit) {
  double largest = 1e-30;
  for (const glm::vec4& v : gpu) largest = std::max(largest, largest_component(glm::vec3(v)));
  Differences d;
  for (size_t i = 0; i < voxels.side_count(); ++i) {
    d.add(largest_component(glm::vec3(gpu[i]) - glm::vec3(cpu[i])) / largest, voxels.sides()[i].cell);
  }
  return d.row(voxels.grid(), std::move(stage), "largest", limit);
}

/// Cells of the CPU from the GPU's, so that later stages start from the same.
CellVolumes to_cell_volumes(const Grid& grid, const CellVolumesGl::Cells& cells) {
  CellVolumes out{vdb::make_float_grid(), vdb::make_vec3s_grid(), vdb::make_vec3s_grid(), vdb::make_vec3s_grid()};
  const auto set = [&](openvdb::Vec3SGrid& into, const openvdb::Coord& at, glm::vec3 v) {
    into.tree().setValue(at, openvdb::Vec3s(v.x, v.y, v.z));
  };
  for (int i = 0; i < int(cell_count(grid)); ++i) {
    if (cells.occupancy[size_t(i)] <= 0.0f) continue;
    const glm::ivec3 c = shared::cell_coord(grid, i);
    const openvdb::Coord at(c.x, c.y, c.z);
    out.occupancy->tree().setValue(at, cells.occupancy[size_t(i)]);
    set(*out.albedo, at, cells.albedo[size_t(i)]);
    set(*out.normal, at, cells.normal[size_t(i)]);
    set(*out.emission, at, cells.emission[size_t(i)]);
  }
  return out;
}

glm::vec3 value_at(const openvdb::Vec3SGrid& grid, glm::ivec3 cell) {
  const openvdb::Vec3s v = grid.tree().getValue(openvdb::Coord(cell.x, cell.y, cell.z));
  return {v.x(), v.y(), v.z()};
}

void compare_cells(const Grid& grid, const CellVolumesGl::Cells& gpu, const CellVolumes& cpu,
                   std::vector<CrosscheckRow>& rows) {
  Differences occupancy, albedo, normal, emission;
  double brightest = 1e-30;
  for (const glm::vec3& e : gpu.emission) brightest = std::max(brightest, largest_component(e));
  for (int i = 0; i < int(cell_count(grid)); ++i) {
    const glm::ivec3 c = shared::cell_coord(grid, i);
    const float o = cpu.occupancy->tree().getValue(openvdb::Coord(c.x, c.y, c.z));
    if (gpu.occupancy[size_t(i)] <= 0.0f && o <= 0.0f) continue;
    occupancy.add(std::abs(double(gpu.occupancy[size_t(i)]) - double(o)), i);
    albedo.add(largest_component(gpu.albedo[size_t(i)] - value_at(*cpu.albedo, c)), i);
    normal.add(largest_component(gpu.normal[size_t(i)] - value_at(*cpu.normal, c)), i);
    emission.add(largest_component(gpu.emission[size_t(i)] - value_at(*cpu.emission, c)) / brightest, i);
  }
  rows.push_back(occupancy.row(grid, "cell occupancy", "1", kAttributeLimit));
  rows.push_back(albedo.row(grid, "cell albedo", "1", kAttributeLimit));
  rows.push_back(normal.row(grid, "cell normal", "1", kAttributeLimit));
  rows.push_back(emission.row(grid, "cell emission", "largest", kAttributeLimit));
}

/// All coefficients of all cells, relative to the largest.
CrosscheckRow compare_radiance(const RadianceVolumeGl& gpu, const RadianceVolume& cpu, std::string stage,
                               double limit) {
  const auto downloaded = gpu.download();
  double largest = 1e-30;
  for (const auto& coefficient : downloaded) {
    for (const glm::vec4& v : coefficient) largest = std::max(largest, largest_component(glm::vec3(v)));
  }
  Differences d;
  for (size_t k = 0; k < downloaded.size(); ++k) {
    for (int i = 0; i < int(cell_count(gpu.grid)); ++i) {
      const glm::vec3 other = value_at(*cpu.sh.at(k), shared::cell_coord(gpu.grid, i));
      d.add(largest_component(glm::vec3(downloaded[k][size_t(i)]) - other) / largest, i);
    }
  }
  return d.row(gpu.grid, std::move(stage), "largest", limit);
}

std::unique_ptr<TransportGl> make_transport_gl(const Grid& grid, const SchemeOptions& scheme) {
  if (scheme.scheme == Scheme::conservative) return std::make_unique<ConservativeTransportGl>(grid, scheme.sh_order);
  return std::make_unique<OrdinatesTransportGl>(grid, scheme);
}

/// The GPU's voxels, downloaded for the CPU's later stages.
struct GpuVoxels {
  SlicedVoxelization voxelization;
  CellVolumesGl cells;
  VoxelGrid voxels;
  gl::PassTimer timer{gl::current_is_software(), false};

  GpuVoxels(const Scene& scene, const Grid& grid) : voxelization(grid), cells(grid) {
    const gl::SceneBuffers buffers(scene);
    voxelization.run(buffers, timer);
    cells.run(buffers, timer);
    voxels = download(voxelization.voxels());
  }
};

class Stages {
 public:
  Stages(const Scene& scene, const VolumeOptions& options, GpuVoxels& gpu)
      : scene_(scene), scheme_(options.scheme), gpu_(gpu), rules_(bounce_rules(options, largest_albedo(scene))) {
    scheme_.coarse_start = false;
    rules_.solver = BounceRules::Solver::plain;
    rules_.warm_start = false;
    rules_.passes_per_run.reset();
  }

  void run(const std::vector<int>& passes, std::vector<CrosscheckRow>& rows) {
    inject(rows);
    if (!carries_sides(scheme_.scheme)) {
      for (int n : passes) pulse(n, rows);
      return;
    }
    for (int n : passes) propagate(n, rows);
    irradiate(rows);
    read_out(rows);
  }

 private:
  const VoxelGrid& voxels() const { return gpu_.voxels; }

  void inject(std::vector<CrosscheckRow>& rows) {
    pieces_ = emitter_pieces(scene_, voxels().grid());
    std::vector<FluxSample> samples = pieces_;
    if (!scene_.lights.empty()) {
      const std::vector<FluxSample> lit = light_flux(EmbreeScene(scene_), kLightTexels);
      samples.insert(samples.end(), lit.begin(), lit.end());
    }
    const VoxelGridGl& on_gpu = gpu_.voxelization.voxels();
    flux_gl_.begin(on_gpu);
    flux_gl_.inject_emitters(on_gpu, samples, gpu_.timer);
    flux_.emitted.assign(voxels().side_count(), glm::vec4(0.0f));
    flux_.punctual = flux_.emitted;
    deposit(voxels(), samples, flux_.emitted, flux_.lost);
    const auto injected = flux_gl_.emitted().download<glm::vec4>(voxels().side_count());
    rows.push_back(compare_power(voxels(), injected, flux_.emitted, "injected flux", kAttributeLimit));
    flux_.emitted = injected;  // from here on both have the GPU's
  }

  void propagate(int n, std::vector<CrosscheckRow>& rows) {
    const VoxelGridGl& on_gpu = gpu_.voxelization.voxels();
    BounceRules rules = rules_;
    rules.bounces.reset();
    rules.iterations = n;
    if (scheme_.scheme == Scheme::ordinates) {  // orders: emission's arrival is the first
      rules.iterations.reset();
      rules.bounces = n - 1;
    }
    bounces_gl_ = std::make_unique<BouncesGl>(make_transport_gl(voxels().grid(), scheme_));
    bounces_gl_->run(on_gpu, flux_gl_, true, rules, gpu_.timer);
    bounces_ = std::make_unique<BouncesCpu>(make_transport(voxels(), scheme_));
    bounces_->run(voxels(), flux_, true, rules);
    const size_t count = voxels().side_count();
    auto gpu = bounces_gl_->received_direct().download<glm::vec4>(count);
    auto cpu = bounces_->received_direct();
    const auto later = bounces_gl_->received_indirect().download<glm::vec4>(count);
    for (size_t i = 0; i < count; ++i) {
      gpu[i] += later[i];
      cpu[i] += bounces_->received_indirect()[i];
    }
    rows.push_back(compare_power(voxels(), gpu, cpu, fmt::format("received, {} passes", n), kPowerLimit));
    rows.back().ties = scheme_.scheme == Scheme::conservative;
  }

  void irradiate(std::vector<CrosscheckRow>& rows) {
    if (!bounces_) return;
    SideIrradianceGl irradiance_gl;
    irradiance_gl.run(gpu_.voxelization.voxels(), flux_gl_, *bounces_gl_, gpu_.timer);
    const SideIrradiance cpu = side_irradiance(voxels(), flux_, *bounces_);
    const size_t count = voxels().side_count();
    rows.push_back(compare_power(voxels(), irradiance_gl.direct().download<glm::vec4>(count), cpu.direct,
                                 "irradiance, direct", kAttributeLimit));
    rows.push_back(compare_power(voxels(), irradiance_gl.indirect().download<glm::vec4>(count), cpu.indirect,
                                 "irradiance, indirect", kAttributeLimit));
  }

  void read_out(std::vector<CrosscheckRow>& rows) {
    if (!bounces_) return;
    const std::vector<glm::vec4> sent = bounces_->sent(voxels(), flux_);
    const auto transport = make_transport_gl(voxels().grid(), scheme_);
    const RadianceVolumeGl gpu = transport->radiance(gpu_.voxelization.voxels(), gl::Buffer(sent));
    rows.push_back(compare_radiance(gpu, bounces_->transport().radiance(sent), "radiance", kAttributeLimit));
  }

  void pulse(int n, std::vector<CrosscheckRow>& rows) {
    PulseVolumeGl gpu(voxels().grid(), scheme_);
    gpu.run(gpu_.voxelization.voxels(), {gpu_.cells.normal_occupancy(), gpu_.cells.albedo(), gpu_.cells.emission()},
            flux_gl_.emitted(), n, gpu_.timer);
    const CellVolumes cells = to_cell_volumes(voxels().grid(), gpu_.cells.download());
    PulseVolumeCpu cpu(voxels(), cells, scheme_);
    cpu.run(flux_.emitted, n);
    rows.push_back(
        compare_radiance(gpu.radiance(), cpu.radiance(), fmt::format("radiance, {} passes", n), kPowerLimit));
  }

  const Scene& scene_;
  SchemeOptions scheme_;
  GpuVoxels& gpu_;
  BounceRules rules_;
  std::vector<FluxSample> pieces_;
  SideFluxGl flux_gl_;
  SideFlux flux_;
  std::unique_ptr<BouncesGl> bounces_gl_;
  std::unique_ptr<BouncesCpu> bounces_;
};

}  // namespace

std::vector<CrosscheckRow> crosscheck(const Scene& scene, const VolumeOptions& options,
                                      const std::vector<int>& passes) {
  const Grid grid = make_grid(scene, options.grid_cells, options.grid_shift_cells, options.grid_box);
  std::vector<CrosscheckRow> rows;
  GpuVoxels gpu(scene, grid);
  compare_voxels(gpu.voxels, voxelize_cpu(scene, grid), rows);
  compare_cells(grid, gpu.cells.download(), cell_volumes_cpu(scene, grid), rows);
  Stages(scene, options, gpu).run(passes, rows);
  return rows;
}

}  // namespace volgi
