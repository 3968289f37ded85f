#include "propagation/volume_cpu.h"

#include <openvdb/openvdb.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstring>
#include <utility>

#include "core/error.h"
#include "core/surface.h"
#include "propagation/ordinates.h"
#include "propagation/transport_conservative_cpu.h"
#include "propagation/transport_ordinates_cpu.h"
#include "voxel/cascade_voxels.h"
#include "voxel/voxelize_cpu.h"
#include "voxel/white_pockets.h"

namespace volgi {

namespace {

constexpr int kMinCoarseGrid = 16;  // below, a coarse part has too few cells to say anything

bool has_coarse_part(const SchemeOptions& scheme, const Grid& grid) {
  return scheme.scheme == Scheme::conservative && scheme.coarse_start.value_or(true) &&
         std::max({grid.cells.x, grid.cells.y, grid.cells.z}) >= kMinCoarseGrid;
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
bool same_sides(const std::vector<VoxelGrid>& a, const std::vector<VoxelGrid>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const VoxelGrid& one, const VoxelGrid& other) { return same_sides(one, other); });
}

/// The same scene in cells of twice the edge: the coarse part of `conservative`.
Grid half_grid(const Grid& grid) {
  Grid half = grid;
  half.cells = (grid.cells + 1) / 2;
  half.cell_size_m = 2.0f * grid.cell_size_m;
  return half;
}

/// What `ordinates` keeps of a block with so many sides, about: voxels, flux, powers, what sweeps know of sides.
std::int64_t bytes_of_block(size_t sides) {
  constexpr size_t kOfTransport = sizeof(std::uint32_t) + 5 * sizeof(glm::vec4);
  const size_t of_side =
      sizeof(shared::Side) + 2 * sizeof(glm::vec4) + BouncesCpu::bytes_for(1) + side_irradiance_bytes(1) + kOfTransport;
  return sides == 0 ? 0 : std::int64_t(sizeof(VoxelGrid::Leaf) + sizeof(sweep::BlockSides) + sides * of_side);
}

/// All ranks, each of which counts the sides of its part.
Decomposition evened_out_by_memory(const Scene& scene, const Grid& grid, OrdinateChoice choice,
                                   const RanksOfVolume& ranks) {
  const BlockBox part = ranks.part();
  std::vector<std::uint32_t> sides;
  expected_sides(scene, grid, part, &sides);
  const glm::ivec3 blocks = leaf_blocks(grid);
  std::vector<std::int64_t> weights(size_t(blocks.y) * size_t(blocks.z), 0);
  for (size_t i = 0; i < sides.size(); ++i) {
    const glm::ivec3 b = part.block(i);
    weights[size_t(b.y) + size_t(blocks.y) * size_t(b.z)] += bytes_of_block(sides[i]);
  }
  ranks.ranks.add(weights);
  for (std::int64_t& w : weights) w += std::int64_t(OrdinatesTransportCpu::bytes_of_column(choice));
  return ranks.decomposition.evened_out(weights);
}

/// Voxels of a rank, with what it knows of others'.
size_t voxels_bytes(const Scene& scene, const Grid& grid, const RanksOfVolume& ranks) {
  const BlockBox part = ranks.part();
  const glm::ivec3 around(0, 1, 1);
  const BlockBox held{glm::max(part.first - around, 0), glm::min(part.last + around, leaf_blocks(grid))};
  const ExpectedSides known = expected_sides(scene, grid, held);
  return VoxelGrid::bytes_for(held, known.sides, known.blocks);
}

}  // namespace

size_t bytes_expected_cpu(const Scene& scene, const Grid& grid, const VolumeOptions& options,
                          const ExpectedSides& expected) {
  const SchemeOptions& scheme = options.scheme;
  const size_t flux = 2 * sizeof(glm::vec4) * expected.sides;
  size_t bytes =
      voxelization_mipmaps(scene).bytes() + VoxelGrid::bytes_for(grid, expected.sides, expected.blocks) + flux;
  if (!carries_sides(scheme.scheme)) {
    return bytes + PulseVolumeCpu::bytes_for(grid, scheme, expected.blocks) + cell_volumes_bytes(expected.blocks);
  }
  bytes += BouncesCpu::bytes_for(expected.sides) + side_irradiance_bytes(expected.sides);
  if (scheme.scheme == Scheme::ordinates)
    return bytes + OrdinatesTransportCpu::bytes_for(grid, choose_ordinates(grid.cells, scheme), expected);
  bytes += ConservativeTransportCpu::bytes_for(grid, scheme.sh_order, expected);
  if (!has_coarse_part(scheme, grid)) return bytes;
  const Grid half = half_grid(grid);
  const ExpectedSides coarse = expected_sides(scene, half);
  return bytes + VoxelGrid::bytes_for(half, coarse.sides, coarse.blocks) +
         ConservativeTransportCpu::bytes_for(half, scheme.sh_order, coarse) + sizeof(glm::vec4) * coarse.sides;
}

size_t bytes_expected_cpu(const Scene& scene, const Cascade& cascade, const VolumeOptions& options) {
  if (cascade.levels() == 1)
    return bytes_expected_cpu(scene, cascade.grids[0], options, expected_sides(scene, cascade.grids[0]));
  size_t bytes = voxelization_mipmaps(scene).bytes();
  ExpectedSides all{};
  for (size_t level = 0; level < cascade.levels(); ++level) {
    const Grid& grid = cascade.grids[level];
    std::vector<std::uint32_t> by_block;
    const BlockBox blocks{glm::ivec3(0), leaf_blocks(grid)};
    expected_sides(scene, grid, blocks, &by_block);
    ExpectedSides own{};
    for (size_t i = 0; i < by_block.size(); ++i) {
      if (by_block[i] == 0 || cascade.covers(level, blocks.block(i))) continue;
      own.sides += by_block[i];
      own.blocks += 1;
    }
    bytes += VoxelGrid::bytes_for(grid, own.sides, own.blocks);
    all.sides += own.sides;
    all.blocks += own.blocks;
  }
  return bytes + 2 * sizeof(glm::vec4) * all.sides + BouncesCpu::bytes_for(all.sides) +
         side_irradiance_bytes(all.sides) +
         OrdinatesTransportCpu::bytes_for(cascade, choose_ordinates(cascade.finest_cells(), options.scheme), all);
}

size_t bytes_expected_cpu(const Scene& scene, const Grid& grid, const VolumeOptions& options,
                          const RanksOfVolume& ranks) {
  const SchemeOptions& scheme = options.scheme;
  const ExpectedSides own = expected_sides(scene, grid, ranks.part());
  const size_t bytes = voxelization_mipmaps(scene).bytes() + voxels_bytes(scene, grid, ranks) +
                       2 * sizeof(glm::vec4) * own.sides + BouncesCpu::bytes_for(own.sides) +
                       side_irradiance_bytes(own.sides);
  if (scheme.scheme == Scheme::ordinates)
    return bytes + OrdinatesTransportCpu::bytes_for(ranks, choose_ordinates(grid.cells, scheme), own);
  const size_t fine = bytes + ConservativeTransportCpu::bytes_for(ranks, scheme.sh_order, own);
  if (!has_coarse_part(scheme, grid)) return fine;
  const Grid half = half_grid(grid);
  const RanksOfVolume of_half{ranks.ranks, Decomposition(leaf_blocks(half), ranks.ranks.count())};
  const ExpectedSides coarse = expected_sides(scene, half, of_half.part());
  return fine + voxels_bytes(scene, half, of_half) +
         ConservativeTransportCpu::bytes_for(of_half, scheme.sh_order, coarse) + sizeof(glm::vec4) * coarse.sides;
}

VolumeCpu::VolumeCpu(const Scene& scene, const VolumeOptions& options, const Ranks* ranks)
    : scene_(scene), options_(options), rules_(bounce_rules(options, scene)), mipmaps_(voxelization_mipmaps(scene)) {
  set_grid();
  if (ranks != nullptr && ranks->count() > 1) {
    refuse_of_ranks(options);
    share_out(*ranks);
  }
  if (options.scheme.scheme == Scheme::ordinates)
    ordinate_set(choose_ordinates(cascade_.finest_cells(), options.scheme).directions);
  if (options.memory_limit)
    refuse_above_limit(
        options,
        ranks_ ? bytes_expected_cpu(scene, grid_, options, *ranks_) : bytes_expected_cpu(scene, cascade_, options),
        "CPU");
}

void VolumeCpu::set_grid() {
  cascade_ = make_cascade(make_grid(scene_, options_.grid_cells, options_.grid_shift_cells, options_.grid_box),
                          options_.cascade);
  grid_ = cascade_.grids.front();
}

/// What each needs is asked of all, so that all decide alike.
void VolumeCpu::share_out(const Ranks& ranks) {
  ranks_.emplace(RanksOfVolume{ranks, Decomposition(leaf_blocks(grid_), ranks.count())});
  if (has_coarse_part()) {  // parts of either grid hold the same of the scene
    half_ranks_.emplace(RanksOfVolume{ranks, Decomposition(leaf_blocks(half_grid(grid_)), ranks.count())});
    ranks_->decomposition = half_ranks_->decomposition.doubled(leaf_blocks(grid_));
  }
  if (!options_.memory_limit) return;
  const auto fits = [&] {
    const std::array<double, 1> own{double(bytes_expected_cpu(scene_, grid_, options_, *ranks_))};
    const std::vector<double> all = ranks.gather(own);
    return *std::max_element(all.begin(), all.end()) <= double(*options_.memory_limit);
  };
  if (fits()) return;
  if (options_.scheme.scheme != Scheme::ordinates) return;
  ranks_->lean = true;
  if (fits()) return;
  const OrdinateChoice choice = choose_ordinates(grid_.cells, options_.scheme);
  ranks_->decomposition = evened_out_by_memory(scene_, grid_, choice, *ranks_);
}

void VolumeCpu::scene_moved() {
  rules_ = bounce_rules(options_, scene_);
  moved_ = true;
}

void VolumeCpu::shift_grid(glm::vec3 cells) {
  if (cells == options_.grid_shift_cells) return;
  options_.grid_shift_cells = cells;
  set_grid();
  if (ranks_) share_out(ranks_->ranks);
  cells_ = {};
  shifted_ = true;
}

void VolumeCpu::move_cascade(glm::vec3 around) {
  if (!options_.cascade.nested()) return;
  const Cascade before = cascade_;
  options_.cascade.around = around;
  set_grid();
  shifted_ = shifted_ || !same_cascade(before, cascade_);
}

VolumeCpu::~VolumeCpu() = default;

bool VolumeCpu::has_coarse_part() const { return volgi::has_coarse_part(options_.scheme, grid_); }

void VolumeCpu::voxelize_half(bool white) {
  const Grid half = half_grid(grid_);
  half_voxels_ =
      half_ranks_ ? voxelize_cpu(scene_, half, mipmaps_, *half_ranks_) : voxelize_cpu(scene_, half, mipmaps_);
  if (white) bound_white_pockets(half_voxels_, half_ranks_ ? &*half_ranks_ : nullptr);
}

std::vector<VoxelGrid> VolumeCpu::voxelized(bool white) {
  if (cascade_.levels() > 1) {
    pocket_cells_ = 0;
    return voxelize_cascade(scene_, cascade_, mipmaps_, white ? &pocket_cells_ : nullptr);
  }
  std::vector<VoxelGrid> one;
  one.push_back(ranks_ ? voxelize_cpu(scene_, grid_, mipmaps_, *ranks_) : voxelize_cpu(scene_, grid_, mipmaps_));
  if (white) pocket_cells_ = bound_white_pockets(one.front(), ranks());
  return one;
}

std::unique_ptr<TransportCpu> VolumeCpu::transport() const {
  if (cascade_.levels() > 1) {
    const glm::ivec3 cells = cascade_.finest_cells();
    return std::make_unique<OrdinatesTransportCpu>(cascade_, levels_, choose_ordinates(cells, options_.scheme),
                                                   choose_source_ordinates(cells, options_.scheme));
  }
  return make_transport(voxels(), options_.scheme, has_coarse_part() ? &half_voxels_ : nullptr, ranks(),
                        half_ranks_ ? &*half_ranks_ : nullptr);
}

void VolumeCpu::voxelize() {
  const bool papers = !carries_sides(options_.scheme.scheme);
  const bool white = may_have_white_pockets(rules_.largest_albedo);
  std::vector<VoxelGrid> fresh = voxelized(white);
  const bool coarse = has_coarse_part();
  // A scene that stands still keeps its transport, with what is in flight in it. What moves may change cells, or the
  // coarse grid's sides, and no side.
  const bool moved = std::exchange(moved_, false);
  if (moved && !papers) cells_ = {};  // made on first use
  const bool only_sides_count = (!moved || !(coarse || papers)) && !std::exchange(shifted_, false);
  if ((bounces_ || pulse_) && only_sides_count && same_sides(fresh, levels_)) return;
  levels_.resize(fresh.size());
  std::move(fresh.begin(), fresh.end(), levels_.begin());  // voxels() stays where it is
  passages_are_old_ = true;
  if (ranks_) halo_.emplace(*ranks_, voxels());
  if (coarse) voxelize_half(white);
  if (papers) {
    cells_ = cell_volumes_cpu(scene_, grid_, mipmaps_);
    pulse_ = std::make_unique<PulseVolumeCpu>(voxels(), cells_, options_.scheme);
  } else if (bounces_) {
    bounces_->set_transport(transport());
  } else {
    bounces_ = std::make_unique<BouncesCpu>(transport(), ranks_ ? &ranks_->ranks : nullptr);
  }
}

void VolumeCpu::set_passages(std::vector<PassageFace> faces) {
  passages_ = std::move(faces);
  if (bounces_) bounces_->transport().set_passages(passages_);
  passages_are_old_ = false;
}

void VolumeCpu::light_in(SideFlux flux) {
  assert(flux.punctual.size() == sides().count() && flux.emitted.size() == sides().count());
  flux_ = std::move(flux);
}

void VolumeCpu::propagate() {
  if (bounces_) {
    bounces_->set_checkpoint(checkpoint_);
    report_ = bounces_->run(sides(), flux_, flux_.emits, rules_, streaming_sky(scene_, options_));
    return;
  }
  std::vector<glm::vec4> all = flux_.punctual;
  const bool by_max = options_.scheme.injection == SchemeOptions::Injection::max;  // emission comes with the cells
  for (size_t i = 0; i < all.size() && !by_max; ++i) all[i] += flux_.emitted[i];
  report_ = pulse_->run(all, options_.iterations.value_or(VolumeOptions::kPulseIterations));
}

void VolumeCpu::irradiate() {
  if (!bounces_) return;
  const VolumeSides all = sides();
  irradiance_.resize(all.levels());
  for (size_t level = 0; level < all.levels(); ++level) {
    irradiance_[level] = side_irradiance_of_level(all, level, flux_, *bounces_, halo_ ? &*halo_ : nullptr);
    join_emission(irradiance_[level]);
  }
}

void VolumeCpu::join_emission(SideIrradiance& irradiance) const {
  if (options_.source == VolumeOptions::Source::lights || !flux_.emits) return;
  // The first arrival in the volume is emission's bounce 1.
  for (size_t i = 0; i < irradiance.indirect.size(); ++i) {
    irradiance.indirect[i] += glm::vec4(glm::vec3(irradiance.direct[i]), 0.0f);
    irradiance.direct[i] = glm::vec4(0.0f, 0.0f, 0.0f, 1.0f);
  }
}

SideIrradiance VolumeCpu::irradiance_but_last() const {
  SideIrradiance irradiance = side_irradiance_but_last(voxels(), flux_, *bounces_);
  join_emission(irradiance);
  return irradiance;
}

const CellVolumes& VolumeCpu::cells() {
  const BlockBox part = ranks_ ? ranks_->part() : BlockBox{glm::ivec3(0), leaf_blocks(grid_)};
  if (!cells_.occupancy) cells_ = cell_volumes_cpu(scene_, grid_, mipmaps_, part);
  return cells_;
}

RadianceVolume VolumeCpu::radiance() const {
  if (cascade_.levels() > 1) throw Error(ExitCode::usage, "--cascades: nested grids have no radiance in free space");
  if (bounces_) bounces_->transport().stream_in(streaming_sky(scene_, options_));
  RadianceVolume volume = pulse_ ? pulse_->radiance() : bounces_->transport().radiance(bounces_->sent(voxels(), flux_));
  if (bounces_) bounces_->transport().stream_in(nullptr);
  for (auto& grid : volume.sh) grid->setTransform(world_from_index(grid_, scene_.world_origin));
  return volume;
}

size_t VolumeCpu::bytes() const {
  size_t sum = mipmaps_.bytes() + half_voxels_.bytes();
  for (const VoxelGrid& level : levels_) sum += level.bytes();
  sum += (flux_.emitted.size() + flux_.punctual.size()) * sizeof(glm::vec4);
  if (bounces_) sum += bounces_->transport().bytes() + BouncesCpu::bytes_for(sides().count());
  for (const SideIrradiance& irradiance : irradiance_) sum += side_irradiance_bytes(irradiance.indirect.size());
  if (pulse_) sum += pulse_->bytes() + cell_volumes_bytes(cells_);
  return sum;
}

}  // namespace volgi
