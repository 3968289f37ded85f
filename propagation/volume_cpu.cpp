#include "propagation/volume_cpu.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "core/surface.h"
#include "core/visibility/light_flux.h"
#include "propagation/ordinates.h"
#include "propagation/side_gather.h"
#include "propagation/transport_conservative_cpu.h"
#include "propagation/transport_ordinates_cpu.h"
#include "voxel/emitter_pieces.h"
#include "voxel/voxelize_cpu.h"

namespace volgi {

namespace {

// Rays of a spot's layer through one cell's edge where the layer sees the grid across its edge (a sun's has twice as
// many): a lit cell gets some 16 samples or more. All power is known beforehand; what few rays get wrong is where edges
// of albedo lie: 1e-4 of the light of cornell, room and thin_wall at 512, 3e-4 at 256, against 2048.
constexpr int kRaysACellEdge = 4;
constexpr int kLeastRays = 512;
constexpr int kMostRays = 1024;

int light_texels(const Grid& grid) {
  return std::clamp(kRaysACellEdge * std::max({grid.cells.x, grid.cells.y, grid.cells.z}), kLeastRays, kMostRays);
}

constexpr int kLeastCoarseGrid = 16;  // below, a coarse part has too few cells to say anything

bool has_coarse_part(const SchemeOptions& scheme, const Grid& grid) {
  return scheme.scheme == Scheme::conservative && scheme.coarse_start.value_or(true) &&
         std::max({grid.cells.x, grid.cells.y, grid.cells.z}) >= kLeastCoarseGrid;
}

/// CellVolumes of so many leaves of 8^3 cells: a float and three vectors a cell. Nodes above leaves are not counted.
size_t cell_volumes_bytes(size_t leaves) {
  return leaves * (openvdb::FloatTree::LeafNodeType(openvdb::Coord(), 0.0f).memUsage() +
                   3 * openvdb::Vec3STree::LeafNodeType(openvdb::Coord(), openvdb::Vec3s(0.0f)).memUsage());
}
size_t cell_volumes_bytes(const CellVolumes& cells) {
  return cells.occupancy ? cell_volumes_bytes(cells.occupancy->tree().leafCount()) : 0;
}

size_t side_irradiance_bytes(size_t sides) { return 2 * sizeof(glm::vec4) * sides; }

bool same_sides(const VoxelGrid& a, const VoxelGrid& b) {
  return a.side_count() == b.side_count() &&
         std::memcmp(a.sides().data(), b.sides().data(), a.side_count() * sizeof(shared::Side)) == 0;
}

/// The same scene in cells of twice the edge: the coarse part of `conservative`.
Grid half_grid(const Grid& grid) {
  Grid half = grid;
  half.cells = (grid.cells + 1) / 2;
  half.cell_size_m = 2.0f * grid.cell_size_m;
  return half;
}

}  // namespace

size_t bytes_expected_cpu(const Scene& scene, const Grid& grid, const VolumeOptions& options,
                          const ExpectedSides& expected) {
  const SchemeOptions& scheme = options.scheme;
  const size_t flux = 2 * sizeof(glm::vec4) * expected.sides;
  size_t bytes =
      voxelization_mipmaps(scene).bytes() + VoxelGrid::bytes_for(grid, expected.sides, expected.blocks) + flux;
  if (options.source == VolumeOptions::Source::first_bounce)
    bytes += size_t(options.virtual_lights) * sizeof(shared::VirtualLight);
  if (!carries_sides(scheme.scheme)) {
    return bytes + PulseVolume::bytes_for(grid, scheme, expected.blocks) + cell_volumes_bytes(expected.blocks);
  }
  bytes += Bounces::bytes_for(expected.sides) + side_irradiance_bytes(expected.sides);
  if (scheme.scheme == Scheme::ordinates)
    return bytes + OrdinatesTransport::bytes_for(grid, choose_ordinates(grid.cells, scheme), expected);
  bytes += ConservativeTransport::bytes_for(grid, scheme.sh_order, expected);
  if (!has_coarse_part(scheme, grid)) return bytes;
  const Grid half = half_grid(grid);
  const ExpectedSides coarse = expected_sides(scene, half);
  return bytes + VoxelGrid::bytes_for(half, coarse.sides, coarse.blocks) +
         ConservativeTransport::bytes_for(half, scheme.sh_order, coarse) + sizeof(glm::vec4) * coarse.sides;
}

VolumeCpu::VolumeCpu(const Scene& scene, const VolumeOptions& options)
    : scene_(scene),
      options_(options),
      grid_(make_grid(scene, options.grid_cells, options.grid_shift_cells)),
      rules_(bounce_rules(options, largest_albedo(scene))),
      mipmaps_(voxelization_mipmaps(scene)) {
  if (options.scheme.scheme == Scheme::ordinates)
    ordinate_set(choose_ordinates(grid_.cells, options.scheme).directions);
  if (options.memory_limit)
    refuse_above_limit(options, bytes_expected_cpu(scene, grid_, options, expected_sides(scene, grid_)), "CPU");
  look_at_geometry();
}

/// What is made of the scene's triangles once for all frames in which they stand still.
void VolumeCpu::look_at_geometry() {
  embree_.reset();
  const bool first_bounce = options_.source == VolumeOptions::Source::first_bounce;
  if (first_bounce) emitters_ = std::make_unique<EmitterPoints>(scene_);
  if (!scene_.lights.empty() || (first_bounce && !emitters_->empty())) embree_ = std::make_unique<EmbreeScene>(scene_);
}

void VolumeCpu::scene_moved() {
  rules_ = bounce_rules(options_, largest_albedo(scene_));
  look_at_geometry();
  moved_ = true;
}

VolumeCpu::~VolumeCpu() = default;

void VolumeCpu::run() {
  voxelize();
  light_in();
  propagate();
  irradiate();
}

bool VolumeCpu::has_coarse_part() const { return volgi::has_coarse_part(options_.scheme, grid_); }

void VolumeCpu::voxelize() {
  const bool papers = !carries_sides(options_.scheme.scheme);
  VoxelGrid fresh = voxelize_cpu(scene_, grid_, mipmaps_);
  const bool coarse = has_coarse_part();
  // A scene that stands still keeps its transport, with what is in flight in it. What moves may change cells, or the
  // coarse grid's sides, and no side.
  const bool moved = std::exchange(moved_, false);
  if (moved && !papers) cells_ = {};  // made when asked for
  const bool only_sides_count = !moved || !(coarse || papers);
  if ((bounces_ || pulse_) && only_sides_count && same_sides(fresh, voxels_)) return;
  voxels_ = std::move(fresh);
  if (coarse) half_voxels_ = voxelize_cpu(scene_, half_grid(grid_), mipmaps_);
  if (papers) {
    cells_ = cell_volumes_cpu(scene_, grid_, mipmaps_);
    pulse_ = std::make_unique<PulseVolume>(voxels_, cells_, options_.scheme);
  } else {
    auto transport = make_transport(voxels_, options_.scheme, coarse ? &half_voxels_ : nullptr);
    if (bounces_) {
      bounces_->set_transport(std::move(transport));
    } else {
      bounces_ = std::make_unique<Bounces>(std::move(transport));
    }
  }
}

void VolumeCpu::light_in() {
  if (options_.source == VolumeOptions::Source::first_bounce) {
    first_bounce_in();
  } else {
    direct_light_in();
  }
}

void VolumeCpu::direct_light_in() {
  flux_.emitted.assign(voxels_.side_count(), glm::vec4(0.0f));
  flux_.punctual.assign(voxels_.side_count(), glm::vec4(0.0f));
  flux_.lost = glm::vec3(0.0f);
  const std::vector<FluxSample> pieces = emitter_pieces(scene_, grid_);
  emits_ = !pieces.empty();
  deposit(voxels_, pieces, flux_.emitted, flux_.lost);
  if (embree_) deposit(voxels_, light_flux(*embree_, light_texels(grid_)), flux_.punctual, flux_.lost);
}

/// What virtual lights bring to the sides. Where orders are counted, emission's goes in apart: it has one order more.
void VolumeCpu::first_bounce_in() {
  flux_.emitted.assign(voxels_.side_count(), glm::vec4(0.0f));
  flux_.punctual = flux_.emitted;
  flux_.lost = glm::vec3(0.0f);
  emits_ = false;
  if (!embree_ || options_.bounces == 0) return;
  const int count = options_.virtual_lights, candidates = options_.virtual_light_candidates;
  virtual_lights_ = candidates > 1 ? chosen_virtual_lights_cpu(*embree_, *emitters_, count, candidates)
                                   : virtual_lights_cpu(*embree_, *emitters_, count);
  const std::span<const shared::VirtualLight> all = virtual_lights_.lights;
  const auto brought_by = [&](std::span<const shared::VirtualLight> lights) {
    const int stride = options_.virtual_light_stride.value_or(automatic_stride(voxels_.side_count(), all.size()));
    return reflected_flux(voxels_, side_gather(voxels_, *embree_, lights, stride));
  };
  if (!options_.bounces || !carries_sides(options_.scheme.scheme)) {
    flux_.punctual = brought_by(all);
    return;
  }
  flux_.punctual = brought_by(all.first(size_t(virtual_lights_.reflected)));
  emits_ = virtual_lights_.emitted() > 0;
  if (emits_) flux_.emitted = brought_by(all.subspan(size_t(virtual_lights_.reflected)));
}

void VolumeCpu::propagate() {
  if (bounces_) {
    report_ = bounces_->run(voxels_, flux_, emits_, rules_);
    return;
  }
  std::vector<glm::vec4> all = flux_.punctual;
  for (size_t i = 0; i < all.size(); ++i) all[i] += flux_.emitted[i];
  report_ = pulse_->run(all, options_.iterations.value_or(VolumeOptions::kPulseIterations));
}

void VolumeCpu::irradiate() {
  if (!bounces_) return;
  irradiance_ = side_irradiance(voxels_, flux_, *bounces_);
  if (options_.source == VolumeOptions::Source::lights || !emits_) return;
  // The first arrival in the volume is emission's bounce 1.
  for (size_t i = 0; i < irradiance_.indirect.size(); ++i) {
    irradiance_.indirect[i] += glm::vec4(glm::vec3(irradiance_.direct[i]), 0.0f);
    irradiance_.direct[i] = glm::vec4(0.0f, 0.0f, 0.0f, 1.0f);
  }
}

const CellVolumes& VolumeCpu::cells() {
  if (!cells_.occupancy) cells_ = cell_volumes_cpu(scene_, grid_, mipmaps_);
  return cells_;
}

RadianceVolume VolumeCpu::radiance() {
  RadianceVolume volume = pulse_ ? pulse_->radiance() : bounces_->transport().radiance(bounces_->sent(voxels_, flux_));
  for (auto& grid : volume.sh) grid->setTransform(world_from_index(grid_, scene_.world_origin));
  return volume;
}

size_t VolumeCpu::bytes() const {
  size_t sum = mipmaps_.bytes() + voxels_.bytes() + half_voxels_.bytes();
  sum += (flux_.emitted.size() + flux_.punctual.size()) * sizeof(glm::vec4);
  sum += virtual_lights_.lights.size() * sizeof(shared::VirtualLight);
  if (bounces_) sum += bounces_->transport().bytes() + Bounces::bytes_for(voxels_.side_count());
  sum += side_irradiance_bytes(irradiance_.indirect.size());
  if (pulse_) sum += pulse_->bytes() + cell_volumes_bytes(cells_);
  return sum;
}

}  // namespace volgi
