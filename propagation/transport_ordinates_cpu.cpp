#include "propagation/transport_ordinates_cpu.h"

#include <openvdb/openvdb.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <xmmintrin.h>

#include <algorithm>
#include <cassert>
#include <cstring>
#include <glm/gtc/constants.hpp>
#include <map>
#include <numeric>

#include "propagation/rim_inflow.h"
#include "voxel/cell_volumes.h"

namespace volgi {

namespace {

using sweep::kBlockCells;
using sweep::kOctet;

/// Light thins out by powers along axes and would end in denormal numbers, many times slower: they count as zero here.
class FlushDenormals {
 public:
  FlushDenormals() : before_(_mm_getcsr()) { _mm_setcsr(before_ | 0x8040u); }  // FTZ | DAZ
  ~FlushDenormals() { _mm_setcsr(before_); }
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;

 private:
  unsigned before_;
};

/// One direction and band in its lane.
void set_lane(sweep::Constants& c, int lane, const OrdinateSet& set, size_t i, Ordinates rule, float cell_size_m) {
  const CellTransfer transfer = cell_transfer(rule, set.directions[i]);
  const glm::vec3 emitted = set.emitted_share(i);
  const glm::vec3 track = radiance_per_watt(set, i, rule, cell_size_m);
  for (int a = 0; a < 3; ++a) {
    for (int out = 0; out < 3; ++out) c.share[a][out][lane] = transfer.share[a][out];
    c.emitted[a][lane] = emitted[a];
    c.track[a][lane] = track[a];
  }
  const glm::vec3 d = set.directions[i];
  const float y00 = 0.5f / std::sqrt(glm::pi<float>());
  const float y1 = std::sqrt(3.0f) * y00;
  const float sh[4] = {y00, y1 * d.y, y1 * d.z, y1 * d.x};
  for (int m = 0; m < 4; ++m) c.sh[m][lane] = sh[m];
}

/// For so many directions of an octant.
int octets_of(int directions) {
  int octets = 0;
  while (2 * octets + 2 * (octets / 3) < directions) ++octets;
  return octets;
}

struct Lane {
  int lane;
  size_t direction;
  int band;
};

/// Where directions and bands lie (sweep::Constants).
std::vector<Lane> lanes_of(int directions) {
  const int in_quads = std::min(directions, 2 * octets_of(directions));
  std::vector<Lane> lanes;
  for (int d = 0; d < directions; ++d) {
    for (int band = 0; band < 3; ++band) {
      const int fourth = kOctet * ((d - in_quads) / 2 * 3 + band) + sweep::kQuad * (d & 1) + 3;
      lanes.push_back({d < in_quads ? sweep::kQuad * d + band : fourth, size_t(d), band});
    }
  }
  return lanes;
}

constexpr size_t kBatch = 16;  // directions of an octant

size_t directions_in(const OrdinateSet& set, size_t batch) {
  return std::min(kBatch, set.directions.size() - batch * kBatch);
}

sweep::Constants make_constants(const OrdinateSet& set, size_t batch, Ordinates rule, float cell_size_m) {
  sweep::Constants c;
  const int directions = int(directions_in(set, batch));
  c.octets = octets_of(directions);
  assert(c.octets <= sweep::kMaxOctets);
  for (const Lane& l : lanes_of(directions)) set_lane(c, l.lane, set, batch * kBatch + l.direction, rule, cell_size_m);
  const int in_quads = std::min(directions, 2 * c.octets);
  // Two directions more in the fourth lanes of three octets, one band each.
  for (int d = in_quads; d < directions; ++d) {
    for (int band = 0; band < 3; ++band) {
      const int octet = (d - in_quads) / 2 * 3 + band;
      c.fourth[octet] = band;
      c.fold[octet][band] = 1.0f;
    }
  }
  return c;
}

bool any_light(const float* values, size_t count) {
  for (size_t i = 0; i < count; i += 32) {
    std::uint32_t bits[32];
    std::memcpy(bits, values + i, sizeof bits);
    std::uint32_t any = 0;
    for (std::uint32_t b : bits) any |= b;
    if (any != 0) return true;
  }
  return false;
}

constexpr std::uint32_t kNoSide = 0xffffffffu;

/// What a block of cells has on its faces beside sides: factors of passages by cell and face.
using PassagesOfBlock = std::map<int, std::array<float, 6>>;  // by leaf_offset; 1: none

void add_passage(const Grid& grid, glm::ivec3 cell, int face, float factor, std::map<int, PassagesOfBlock>& blocks) {
  const int block = block_index(leaf_blocks(grid), cell >> kLeafShift);
  auto [of_cell, is_new] = blocks[block].try_emplace(leaf_offset(cell));
  if (is_new) of_cell->second.fill(1.0f);
  of_cell->second[size_t(face)] = factor;
}

std::map<int, PassagesOfBlock> passages_by_block(const VoxelGrid& voxels, std::span<const PassageFace> passages) {
  std::map<int, PassagesOfBlock> blocks;
  for (const PassageFace& p : passages) {
    const int face = 2 * p.axis + 1;
    add_passage(voxels.grid(), p.cell, face, p.factor, blocks);
    add_passage(voxels.grid(), p.cell + shared::face_step(face), face - 1, p.factor, blocks);
  }
  return blocks;
}

/// Faces with sides in a block's order, as the kernels want them.
struct PackedSides {
  std::vector<std::uint32_t>& number;  // in the voxels, or kNoSide
  std::vector<float>& passes;          // 1 - tau
};

/// Sides of a block as the kernels want them; those of a cell follow each other.
/// @param number  of the voxels' first side.
sweep::BlockSides pack_block(const VoxelGrid& voxels, size_t number, glm::ivec3 block, const PassagesOfBlock& passages,
                             PackedSides packed_sides) {
  sweep::BlockSides packed{};
  packed.first_side = std::uint32_t(packed_sides.number.size());
  const VoxelGrid::Leaf* leaf = voxels.leaf(block);
  const glm::ivec3 extent = glm::min(glm::ivec3(kBlockCells), voxels.grid().cells - kBlockCells * block);
  for (int z = 0; z < extent.z; ++z) {
    for (int y = 0; y < extent.y; ++y) {
      for (int x = 0; x < extent.x; ++x) {
        const int offset = leaf_offset({x, y, z});
        const glm::uvec2 cell = leaf != nullptr ? VoxelGrid::unpack(leaf->buffer().data()[offset]) : glm::uvec2(0);
        const auto passage = passages.find(offset);
        std::uint32_t faces = cell.y & 63u;
        for (int f = 0; f < 6 && passage != passages.end(); ++f)
          faces |= passage->second[size_t(f)] != 1.0f ? 1u << f : 0u;
        if (faces == 0) continue;
        const int row = z * kBlockCells + y;
        packed.cells[row * kBlockCells + x] =
            sweep::pack_cell(faces, std::uint32_t(packed_sides.number.size()) - packed.first_side);
        packed.rows[0][row] |= static_cast<unsigned char>(1u << x);
        packed.rows[1][row] |= static_cast<unsigned char>(1u << (extent.x - 1 - x));
        for (int f = 0; f < 6; ++f) {
          if (((faces >> f) & 1u) == 0) continue;
          const bool is_side = shared::has_side(cell, f);
          const std::uint32_t side = is_side ? shared::side_index(cell, f) : kNoSide;
          packed_sides.number.push_back(is_side ? std::uint32_t(number) + side : kNoSide);
          packed_sides.passes.push_back(is_side ? 1.0f - std::min(voxels.sides()[side].coverage, 1.0f)
                                                : passage->second[size_t(f)]);
        }
      }
    }
  }
  return packed;
}

}  // namespace

/// Radiance of the blocks that light reaches, in OpenVDB's leaves.
struct OrdinatesTransportCpu::RadianceLeaves {
  using Tree = openvdb::Vec3SGrid::TreeType;
  using Leaf = Tree::LeafNodeType;
  using Coefficients = std::array<std::unique_ptr<Leaf>, 4>;
  std::vector<Coefficients> by_block;

  const BlockBox part;

  explicit RadianceLeaves(const BlockBox& p) : by_block(p.count()), part(p) {}
  /// A row of blocks is one thread's: no other one asks for the same block.
  void attach(sweep::Block& b, glm::ivec3 block) {
    static_assert(sizeof(openvdb::Vec3s) == 3 * sizeof(float));
    Coefficients& leaves = by_block[part.index(block)];
    for (size_t m = 0; m < 4; ++m) {
      if (!leaves[m]) {
        const glm::ivec3 origin = kBlockCells * block;
        leaves[m] = std::make_unique<Leaf>(openvdb::Coord(origin.x, origin.y, origin.z), openvdb::Vec3s(0.0f), false);
      }
      b.radiance[m] = leaves[m]->buffer().data()->asPointer();
    }
  }
  RadianceVolume volume(const Grid& grid) &&;
};

RadianceVolume OrdinatesTransportCpu::RadianceLeaves::volume(const Grid& grid) && {
  tbb::parallel_for(size_t(0), by_block.size(), [&](size_t block) {
    Coefficients& leaves = by_block[block];
    if (!leaves[0]) return;
    Leaf::NodeMaskType lit;
    for (openvdb::Index i = 0; i < Leaf::SIZE; ++i) lit.set(i, leaves[0]->getValue(i) != openvdb::Vec3s(0.0f));
    for (auto& leaf : leaves) leaf->setValueMask(lit);
  });
  RadianceVolume volume;
  for (size_t m = 0; m < 4; ++m) {
    auto sh = vdb::make_vec3s_grid();
    sh->setName(sh_grid_name(int(m)));
    sh->setTransform(world_from_index(grid, glm::dvec3(0.0)));
    for (Coefficients& leaves : by_block) {
      if (leaves[m] && !leaves[m]->isEmpty()) sh->tree().addLeaf(leaves[m].release());
    }
    volume.sh.push_back(sh);
  }
  return volume;
}

OrdinatesTransportCpu::Angles OrdinatesTransportCpu::make_angles(OrdinateChoice choice, float cell_size_m) {
  const OrdinateSet set = ordinate_set(choice.directions);
  Angles angles{choice, {}, {}, 0};
  for (size_t b = 0; b * kBatch < set.directions.size(); ++b)
    angles.batches.push_back(make_constants(set, b, choice.rule, cell_size_m));
  return angles;
}

OrdinatesTransportCpu::OrdinatesTransportCpu(const VolumeSides& sides, const Cascade* cascade,
                                             std::span<const VoxelGrid> levels, OrdinateChoice choice,
                                             const sweep::Kernels* kernels, const RanksOfVolume* ranks,
                                             SweepPipeline::AtOnce at_once, std::optional<OrdinateChoice> sources)
    : all_sides_(sides),
      voxels_(sides.level(0)),
      cascade_(cascade),
      kernels_(kernels != nullptr ? *kernels : sweep::available().kernels[0]),
      all_(make_angles(choice, voxels_.grid().cell_size_m)),
      pipeline_(ranks, voxels_.part(), face_floats(), with_inner_grids(cascade, face_floats(), at_once)) {
  if (sources) sources_ = make_angles(*sources, voxels_.grid().cell_size_m);
  assert(!sources_ || sources_->batches[0].octets == all_.batches[0].octets);
  if (cascade != nullptr) nested_.emplace(*cascade, levels, face_floats(), pipeline_.octants_at_once());
  pack_sides({});
}

OrdinatesTransportCpu::OrdinatesTransportCpu(const VoxelGrid& voxels, OrdinateChoice choice,
                                             const sweep::Kernels* kernels, const RanksOfVolume* ranks,
                                             SweepPipeline::AtOnce at_once, std::optional<OrdinateChoice> sources)
    : OrdinatesTransportCpu(VolumeSides(voxels), nullptr, {}, choice, kernels, ranks, at_once, sources) {}

OrdinatesTransportCpu::OrdinatesTransportCpu(const Cascade& cascade, std::span<const VoxelGrid> levels,
                                             OrdinateChoice choice, std::optional<OrdinateChoice> sources,
                                             SweepPipeline::AtOnce at_once)
    : OrdinatesTransportCpu(VolumeSides(cascade, levels), &cascade, levels, choice, nullptr, nullptr, at_once,
                            sources) {}

/// A cascade is there to take little memory; the outermost grid has few blocks, so threads have octants each.
SweepPipeline::AtOnce OrdinatesTransportCpu::with_inner_grids(const Cascade* cascade, size_t face_floats,
                                                              SweepPipeline::AtOnce at_once) {
  if (cascade == nullptr || at_once.of_one > 0) return at_once;
  const BlockBox outermost{glm::ivec3(0), leaf_blocks(cascade->grids.front())};
  const size_t of_octant = NestedFaces::bytes_for(*cascade, face_floats) +
                           SweepPipeline::bytes_for(nullptr, outermost, face_floats, {.of_one = 1});
  at_once.of_one = 8 * of_octant > SweepPipeline::kManyFlowsOfRank ? 2 : 8;
  return at_once;
}

void OrdinatesTransportCpu::set_passages(std::span<const PassageFace> faces) {
  if (!faces.empty() || side_.size() != all_sides_.count()) pack_sides(faces);
}

void OrdinatesTransportCpu::pack_sides(std::span<const PassageFace> passages) {
  const std::map<int, PassagesOfBlock> of_blocks = passages_by_block(voxels_, passages);
  std::vector<float> passes;
  block_sides_.clear();
  side_.clear();
  side_.reserve(all_sides_.count());
  passes.reserve(all_sides_.count());
  sides_of_block_.resize(all_sides_.levels());
  for (size_t level = 0; level < all_sides_.levels(); ++level) {
    const VoxelGrid& voxels = all_sides_.level(level);
    const BlockBox& part = voxels.part();
    std::vector<int>& of_block = sides_of_block_[level];
    of_block.assign(part.count(), -1);
    for (size_t i = 0; i < of_block.size(); ++i) {
      const glm::ivec3 block = part.block(i);
      const auto there = level == 0 ? of_blocks.find(block_index(voxels.blocks(), block)) : of_blocks.end();
      if (voxels.leaf(block) == nullptr && there == of_blocks.end()) continue;
      of_block[i] = int(block_sides_.size());
      block_sides_.push_back(pack_block(voxels, all_sides_.first(level), block,
                                        there != of_blocks.end() ? there->second : PassagesOfBlock{}, {side_, passes}));
    }
  }
  assert(side_.size() >= all_sides_.count());
  sends_.resize(block_sides_.size());
  sent_.assign(side_.size(), glm::vec4(0.0f));
  for (size_t i = 0; i < side_.size(); ++i) sent_[i].w = passes[i];  // constant
  arrived_.assign(4 * side_.size(), glm::vec4(0.0f));
}

void OrdinatesTransportCpu::begin(std::span<const glm::vec4> sent) {
  assert(sent.size() == all_sides_.count());
  tbb::parallel_for(size_t(0), block_sides_.size(), [&](size_t b) {
    const size_t first = block_sides_[b].first_side;
    const size_t last = b + 1 < block_sides_.size() ? block_sides_[b + 1].first_side : side_.size();
    bool sends = false;
    for (size_t i = first; i < last; ++i) {
      if (side_[i] == kNoSide) continue;
      sent_[i] = glm::vec4(glm::vec3(sent[side_[i]]), sent_[i].w);
      sends = sends || glm::vec3(sent_[i]) != glm::vec3(0.0f);
    }
    sends_[b] = sends ? 1 : 0;
  });
}

void OrdinatesTransportCpu::stream_in(const Sky* sky) {
  streams_in_ = sky != nullptr;
  if (sky == nullptr) return;
  make_inflow(*sky, all_);
  if (sources_) make_inflow(*sky, *sources_);
}

/// The step kernel is handed the power of a cell, of which the upwind faces' shares are what comes in: the same cell
/// for all three. The characteristic one is handed the power through the face.
void OrdinatesTransportCpu::make_inflow(const Sky& sky, Angles& angles) const {
  if (sky.id() == angles.inflow_of) return;
  angles.inflow_of = sky.id();
  const OrdinateSet set = ordinate_set(angles.choice.directions);
  const size_t n = set.directions.size();
  const std::vector<glm::vec3> flux = rim_inflow(sky, set);
  angles.inflow.resize(angles.batches.size());
  for (size_t batch = 0; batch < angles.batches.size(); ++batch) {
    for (size_t octant = 0; octant < 8; ++octant) {
      std::array<Floats, 3>& by_axis = angles.inflow[batch][octant];
      for (Floats& lanes : by_axis) lanes.assign(sweep::kMaxLanes, 0.0f);
      for (const Lane& l : lanes_of(int(directions_in(set, batch)))) {
        const size_t d = batch * kBatch + l.direction;
        glm::vec3 handed = inflow_per_flux(set, d, voxels_.grid().cell_size_m) * flux[octant * n + d][l.band];
        if (angles.choice.rule == Ordinates::step)
          handed /= cell_transfer(angles.choice.rule, set.directions[d]).share[0];
        for (int axis = 0; axis < 3; ++axis) by_axis[size_t(axis)][size_t(l.lane)] = handed[axis];
      }
    }
  }
}

/// What comes in through the grid's rim across y or z.
void OrdinatesTransportCpu::fill_rim(SweepPipeline::Task task, int axis) {
  const SweepPipeline::Plane plane = pipeline_.plane(task, axis);
  std::fill(plane.lit, plane.lit + plane.faces, static_cast<unsigned char>(streams_in_ ? 1 : 0));
  for (size_t face = 0; face < plane.faces && streams_in_; ++face)
    kernels_.fill_face(constants().octets, angles().inflow[batch_][size_t(task.octant)][size_t(axis)].data(),
                       plane.values + face * face_floats());
}

bool OrdinatesTransportCpu::advance(std::span<glm::vec4> received, int /*max_passes*/, const BounceRules& /*rules*/,
                                    BounceReport& report) {
  assert(received.size() == all_sides_.count());
  for (batch_ = 0; batch_ < angles().batches.size(); ++batch_) {
    sweep(false, nullptr);
    add_arrived(received);
  }
  batch_ = 0;
  report.passes += 1;
  return true;
}

/// What the octants have brought, times what sides stop of it; leaves nothing behind.
void OrdinatesTransportCpu::add_arrived(std::span<glm::vec4> received) {
  tbb::parallel_for(tbb::blocked_range<size_t>(0, side_.size(), 4096), [&](const tbb::blocked_range<size_t>& sides) {
    for (size_t i = sides.begin(); i < sides.end(); ++i) {
      glm::vec4* a = &arrived_[4 * i];
      if (side_[i] != kNoSide) {
        glm::vec4& r = received[side_[i]];
        r = glm::vec4(glm::vec3(r) + (1.0f - sent_[i].w) * glm::vec3((a[0] + a[1]) + (a[2] + a[3])), r.w);
      }
      std::fill(a, a + 4, glm::vec4(0.0f));
    }
  });
}

RadianceVolume OrdinatesTransportCpu::radiance(std::span<const glm::vec4> sent) {
  assert(cascade_ == nullptr);
  begin(sent);
  RadianceLeaves leaves(voxels_.part());
  for (batch_ = 0; batch_ < angles().batches.size(); ++batch_) sweep(true, &leaves);  // octants add to the same cells
  batch_ = 0;
  std::fill(arrived_.begin(), arrived_.end(), glm::vec4(0.0f));
  return std::move(leaves).volume(voxels_.grid());
}

/// Octants do not depend on each other. Where threads share what is to be done evenly, rows of blocks need not be
/// shared out.
void OrdinatesTransportCpu::sweep(bool in_order, RadianceLeaves* leaves) {
  const auto threads = size_t(tbb::this_task_arena::max_concurrency());
  const size_t at_once = pipeline_.alone() ? 8 : threads;
  pipeline_.start(in_order);
  for (auto tasks = pipeline_.next(at_once); !tasks.empty(); tasks = pipeline_.next(at_once)) {
    const bool threaded = tasks.size() % threads != 0;
    tbb::parallel_for(
        size_t(0), tasks.size(), [&](size_t i) { sweep_chunk(tasks[i], threaded, leaves); }, tbb::simple_partitioner());
    for (const SweepPipeline::Task& task : tasks) pipeline_.finished(task);
  }
  pipeline_.end();
}

/// Rows of blocks along x, by (y,z) along the flow; those of one diagonal y + z do not depend on each other.
void OrdinatesTransportCpu::sweep_chunk(SweepPipeline::Task task, bool threaded, RadianceLeaves* leaves) {
  const glm::ivec3 n = voxels_.part().size();
  for (int axis = 1; axis <= 2; ++axis) {
    if (pipeline_.at_rim(task.octant, axis)) fill_rim(task, axis);
  }
  if (!threaded) {
    for (int z = 0; z < n.z; ++z) {
      for (int y = 0; y < n.y; ++y) sweep_row(task, y, z, leaves);
    }
    return;
  }
  for (int diagonal = 0; diagonal <= n.y + n.z - 2; ++diagonal) {
    const int first = std::max(0, diagonal - (n.y - 1));
    const int last = std::min(n.z - 1, diagonal);
    tbb::parallel_for(first, last + 1, [&](int z) { sweep_row(task, diagonal - z, z, leaves); });
  }
}

void OrdinatesTransportCpu::sweep_row(SweepPipeline::Task task, int y, int z, RadianceLeaves* leaves) {
  const FlushDenormals flush;
  const BlockBox& part = voxels_.part();
  const glm::ivec3 n = part.size();
  const int octant = task.octant, width = pipeline_.chunk_blocks(), first_x = width * task.chunk;
  const glm::ivec3 positive(octant & 1, (octant >> 1) & 1, octant >> 2);
  const size_t face = face_floats(), row = size_t(y) + size_t(n.y) * size_t(z);
  const SweepPipeline::Plane through_y = pipeline_.plane(task, 1), through_z = pipeline_.plane(task, 2);
  alignas(64) float of_row[sweep::kBlockFace * sweep::kMaxLanes];
  unsigned char of_row_lit = 0;
  const bool several = pipeline_.chunks() > 1;
  float* const x_carried = several ? pipeline_.carried(octant, row) : of_row;
  unsigned char& x_lit = several ? pipeline_.carried_lit(octant, row) : of_row_lit;
  if (task.chunk == 0) {
    x_lit = streams_in_ ? 1 : 0;
    if (streams_in_)
      kernels_.fill_face(constants().octets, angles().inflow[batch_][size_t(octant)][0].data(), x_carried);
  }
  for (int x = first_x; x < std::min(first_x + width, n.x); ++x) {
    const glm::ivec3 along(x, y, z);
    const glm::ivec3 block = part.first + positive * along + (1 - positive) * (n - 1 - along);
    const size_t by_y = size_t(x - first_x) + size_t(width) * size_t(z);
    const size_t by_z = size_t(x - first_x) + size_t(width) * size_t(y);
    sweep_turn(octant,
               {0,
                block,
                {{{x_carried, &x_lit},
                  {through_y.values + by_y * face, &through_y.lit[by_y]},
                  {through_z.values + by_z * face, &through_z.lit[by_z]}}}},
               leaves);
  }
}

void OrdinatesTransportCpu::sweep_turn(int octant, const Turn& turn, RadianceLeaves* leaves) {
  if (cascade_ != nullptr && cascade_->covers(turn.level, turn.block)) {
    sweep_inside(octant, turn);
    return;
  }
  const VoxelGrid& voxels = all_sides_.level(turn.level);
  const size_t face = face_floats();
  const auto& [x, y, z] = turn.faces;
  const int sides = sides_of_block_[turn.level][voxels.part().index(turn.block)];
  if (*x.lit == 0 && *y.lit == 0 && *z.lit == 0 && (sides < 0 || sends_[size_t(sides)] == 0)) return;
  const glm::ivec3 extent = glm::min(glm::ivec3(kBlockCells), voxels.grid().cells - kBlockCells * turn.block);
  sweep::Block b{};
  b.x = x.values;
  b.y = y.values;
  b.z = z.values;
  for (const NestedFaces::Face& f : turn.faces) {
    if (*f.lit == 0) std::fill(f.values, f.values + face, 0.0f);
  }
  for (int a = 0; a < 3; ++a) b.extent[a] = extent[a];
  b.octant = octant;
  if (sides >= 0) {
    const size_t first = block_sides_[size_t(sides)].first_side;
    b.sides = &block_sides_[size_t(sides)];
    b.sent = &sent_[first].x;
    b.arrived = &arrived_[4 * first].x;
  }
  if (leaves != nullptr) leaves->attach(b, turn.block);
  kernels_.kernel(angles().choice.rule == Ordinates::characteristic, constants().octets, leaves != nullptr)(constants(),
                                                                                                            b);
  for (const NestedFaces::Face& f : turn.faces) *f.lit = any_light(f.values, face) ? 1 : 0;
}

/// The blocks of the next level that have taken a block's place, upwind ones first.
void OrdinatesTransportCpu::sweep_inside(int octant, const Turn& turn) {
  const int slot = pipeline_.slot(octant), ratio = cascade_->ratio, octets = constants().octets;
  const glm::ivec3 positive(octant & 1, (octant >> 1) & 1, octant >> 2);
  const glm::ivec3 first = nested_->first_inside(turn.level, turn.block);
  nested_->enter(kernels_, octets, slot, octant, turn.level, turn.block, turn.faces);
  glm::ivec3 along;
  for (along.z = 0; along.z < ratio; ++along.z) {
    for (along.y = 0; along.y < ratio; ++along.y) {
      for (along.x = 0; along.x < ratio; ++along.x) {
        const glm::ivec3 block = first + positive * along + (1 - positive) * (ratio - 1 - along);
        sweep_turn(octant, {turn.level + 1, block, nested_->faces(slot, turn.level + 1, block)}, nullptr);
      }
    }
  }
  nested_->leave(kernels_, octets, slot, octant, turn.level, turn.block, turn.faces);
}

size_t OrdinatesTransportCpu::bytes_for(const Grid& grid, OrdinateChoice choice, const ExpectedSides& expected) {
  const BlockBox all{glm::ivec3(0), leaf_blocks(grid)};
  return bytes_of_sides(all, expected) +
         SweepPipeline::bytes_for(nullptr, all, face_floats(octets_of(std::min(choice.directions / 8, int(kBatch)))));
}

size_t OrdinatesTransportCpu::bytes_for(const Cascade& cascade, OrdinateChoice choice, const ExpectedSides& expected) {
  const size_t face = face_floats(octets_of(std::min(choice.directions / 8, int(kBatch))));
  const BlockBox all{glm::ivec3(0), leaf_blocks(cascade.grids[0])};
  const SweepPipeline::AtOnce at_once = with_inner_grids(&cascade, face, {});
  const auto octants = size_t(SweepPipeline::octants_at_once(all, face, at_once));
  size_t blocks = 0;
  for (const Grid& grid : cascade.grids) blocks += BlockBox{glm::ivec3(0), leaf_blocks(grid)}.count();
  return bytes_of_sides(all, expected) + (blocks - all.count()) * sizeof(int) +
         SweepPipeline::bytes_for(nullptr, all, face, at_once) + octants * NestedFaces::bytes_for(cascade, face);
}

size_t OrdinatesTransportCpu::bytes_for(const RanksOfVolume& ranks, OrdinateChoice choice,
                                        const ExpectedSides& expected) {
  return bytes_of_sides(ranks.part(), expected) +
         SweepPipeline::bytes_for(&ranks, ranks.part(),
                                  face_floats(octets_of(std::min(choice.directions / 8, int(kBatch)))));
}

size_t OrdinatesTransportCpu::bytes_of_column(OrdinateChoice choice) {
  constexpr size_t kOctants = 2;
  return kOctants * sizeof(float) * face_floats(octets_of(std::min(choice.directions / 8, int(kBatch))));
}

size_t OrdinatesTransportCpu::bytes_of_sides(const BlockBox& part, const ExpectedSides& expected) {
  return sizeof(OrdinatesTransportCpu) + expected.blocks * (sizeof(sweep::BlockSides) + 1) +
         part.count() * sizeof(int) + expected.sides * (sizeof(std::uint32_t) + 5 * sizeof(glm::vec4));
}

size_t OrdinatesTransportCpu::bytes() const {
  size_t blocks = 0;
  for (const auto& of_level : sides_of_block_) blocks += of_level.size();
  return sizeof *this + block_sides_.size() * (sizeof(sweep::BlockSides) + 1) + blocks * sizeof(int) +
         side_.size() * (sizeof(std::uint32_t) + 5 * sizeof(glm::vec4)) + pipeline_.bytes() +
         (nested_ ? nested_->bytes() : 0);
}

}  // namespace volgi
