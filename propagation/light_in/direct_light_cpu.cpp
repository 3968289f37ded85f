#include "propagation/light_in/direct_light_cpu.h"

#include <algorithm>
#include <cassert>

#include "core/visibility/light_flux.h"
#include "propagation/light_in/face_light_cpu.h"
#include "voxel/emitter_pieces.h"

namespace volgi {

namespace {

// Rays of a spot's layer through one cell's edge where the layer sees the grid across its edge (a sun's has twice as
// many): a lit cell gets some 16 samples or more. All power is known beforehand; what few rays get wrong is where edges
// of albedo lie: 1e-4 of the light of cornell, room and thin_wall at 512, 3e-4 at 256, against 2048.
constexpr int kRaysPerCellEdge = 4;
constexpr int kMinRays = 512;
constexpr int kMaxRays = 1024;

int light_texels(const Grid& grid) {
  return std::clamp(kRaysPerCellEdge * std::max({grid.cells.x, grid.cells.y, grid.cells.z}), kMinRays, kMaxRays);
}

}  // namespace

DirectLightCpu::DirectLightCpu(const Scene& scene, bool by_rays) : scene_(scene), by_rays_(by_rays) { scene_moved(); }

void DirectLightCpu::scene_moved() {
  embree_.reset();
  if (by_rays_ && !scene_.lights.empty()) embree_ = std::make_unique<EmbreeScene>(scene_);
}

const EmbreeScene* DirectLightCpu::embree() const {
  if (by_rays_ && !embree_) embree_ = std::make_unique<EmbreeScene>(scene_);
  return embree_.get();
}

SideFlux DirectLightCpu::flux(const VolumeSides& sides) const {
  SideFlux flux;
  flux.emitted.assign(sides.count(), glm::vec4(0.0f));
  flux.punctual = flux.emitted;
  const Grid grid = sides.finest_grid();
  const std::vector<FluxSample> pieces = emitter_pieces(scene_, grid);
  flux.emits = !pieces.empty();
  deposit(sides, pieces, flux.emitted, flux.lost);
  if (scene_.lights.empty()) return flux;
  assert(by_rays_ || sides.levels() == 1);
  const int texels = light_texels(grid);
  deposit(sides, by_rays_ ? light_flux(*embree_, texels) : face_light(scene_, sides.level(0), texels), flux.punctual,
          flux.lost);
  return flux;
}

SideFlux DirectLightCpu::flux(const VoxelGrid& voxels, const RanksOfVolume& ranks) const {
  SideFlux flux;
  flux.emitted.assign(voxels.side_count(), glm::vec4(0.0f));
  flux.punctual = flux.emitted;
  const std::vector<FluxSample> pieces = emitter_pieces(scene_, voxels.grid());
  flux.emits = !pieces.empty();
  const auto rank = size_t(ranks.ranks.rank()), count = size_t(ranks.ranks.count());
  std::vector<NumberedFluxSample> shared_out;
  for (size_t i = rank; i < pieces.size(); i += count) shared_out.push_back({pieces[i], i});
  deposit(voxels, ranks, shared_out, flux.emitted, flux.lost);
  if (scene_.lights.empty()) return flux;
  const int texels = light_texels(voxels.grid());
  const auto lit =
      by_rays_ ? light_flux(*embree_, texels, int(rank), int(count)) : face_light(scene_, voxels, ranks, texels);
  deposit(voxels, ranks, lit, flux.punctual, flux.lost);
  return flux;
}

SideFlux direct_light(const Scene& scene, const VolumeCpu& volume) {
  const DirectLightCpu light(scene, lights_by_rays(scene, volume.options()));
  return volume.ranks() != nullptr ? light.flux(volume.voxels(), *volume.ranks()) : light.flux(volume.sides());
}

void run_with_direct_light(VolumeCpu& volume, const Scene& scene) {
  volume.voxelize();
  volume.light_in(direct_light(scene, volume));
  volume.propagate();
  volume.irradiate();
}

}  // namespace volgi
