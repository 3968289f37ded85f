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

/// Of the light between the blocks of one octant.
size_t flow_bytes(glm::ivec3 blocks, size_t face_floats) {
  return size_t(blocks.x) * size_t(blocks.y + blocks.z) * (face_floats * sizeof(float) + 1);
}

/// Octants that are swept at the same time, or one.
size_t flow_count(size_t bytes_of_one, size_t many) { return 8 * bytes_of_one > many ? 1 : 8; }

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

/// Sides of a block as the kernels want them; those of a cell follow each other in `side`.
sweep::BlockSides pack_block(const VoxelGrid& voxels, glm::ivec3 block, std::vector<std::uint32_t>& side) {
  sweep::BlockSides packed{};
  packed.first_side = std::uint32_t(side.size());
  const std::int64_t* cells = voxels.leaf(block)->buffer().data();
  const glm::ivec3 extent = glm::min(glm::ivec3(kBlockCells), voxels.grid().cells - kBlockCells * block);
  for (int z = 0; z < extent.z; ++z) {
    for (int y = 0; y < extent.y; ++y) {
      for (int x = 0; x < extent.x; ++x) {
        const glm::uvec2 cell = VoxelGrid::unpack(cells[leaf_offset({x, y, z})]);
        const std::uint32_t faces = cell.y & 63u;
        if (faces == 0) continue;
        const int row = z * kBlockCells + y;
        packed.cells[row * kBlockCells + x] = sweep::pack_cell(faces, std::uint32_t(side.size()) - packed.first_side);
        packed.rows[0][row] |= static_cast<unsigned char>(1u << x);
        packed.rows[1][row] |= static_cast<unsigned char>(1u << (extent.x - 1 - x));
        for (std::uint32_t i = 0; i < shared::count_bits(faces); ++i) side.push_back(cell.x + i);
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

  explicit RadianceLeaves(glm::ivec3 blocks) : by_block(size_t(blocks.x) * size_t(blocks.y) * size_t(blocks.z)) {}
  /// A row of blocks is one thread's: no other one asks for the same block.
  void attach(sweep::Block& b, glm::ivec3 blocks, glm::ivec3 block) {
    static_assert(sizeof(openvdb::Vec3s) == 3 * sizeof(float));
    Coefficients& leaves = by_block[size_t(block_index(blocks, block))];
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

OrdinatesTransportCpu::OrdinatesTransportCpu(const VoxelGrid& voxels, OrdinateChoice choice,
                                             const sweep::Kernels* kernels, size_t many_flows)
    : voxels_(voxels), choice_(choice), kernels_(kernels != nullptr ? *kernels : sweep::available().kernels[0]) {
  const OrdinateSet set = ordinate_set(choice.directions);
  for (size_t b = 0; b * kBatch < set.directions.size(); ++b)
    batches_.push_back(make_constants(set, b, choice.rule, voxels.grid().cell_size_m));
  const glm::ivec3 n = voxels.blocks();
  flows_.resize(flow_count(flow_bytes(n, face_floats()), many_flows));
  for (Flow& flow : flows_) {
    flow.y_lit.resize(size_t(n.x) * size_t(n.z));
    flow.z_lit.resize(size_t(n.x) * size_t(n.y));
    flow.y.resize(flow.y_lit.size() * face_floats());
    flow.z.resize(flow.z_lit.size() * face_floats());
  }
  pack_sides();
}

void OrdinatesTransportCpu::pack_sides() {
  const glm::ivec3 n = voxels_.blocks();
  sides_of_block_.assign(size_t(n.x) * size_t(n.y) * size_t(n.z), -1);
  side_.reserve(voxels_.side_count());
  for (glm::ivec3 b(0); b.z < n.z; ++b.z) {
    for (b.y = 0; b.y < n.y; ++b.y) {
      for (b.x = 0; b.x < n.x; ++b.x) {
        if (voxels_.leaf(b) == nullptr) continue;
        sides_of_block_[size_t(block_index(n, b))] = int(block_sides_.size());
        block_sides_.push_back(pack_block(voxels_, b, side_));
      }
    }
  }
  assert(side_.size() == voxels_.side_count());
  sends_.resize(block_sides_.size());
  sent_.resize(side_.size());
  for (size_t i = 0; i < side_.size(); ++i) {
    sent_[i].w = 1.0f - std::min(voxels_.sides()[side_[i]].coverage, 1.0f);  // constant
  }
  arrived_.resize(4 * side_.size());
}

void OrdinatesTransportCpu::begin(std::span<const glm::vec4> sent) {
  assert(sent.size() == voxels_.side_count());
  tbb::parallel_for(size_t(0), block_sides_.size(), [&](size_t b) {
    const size_t first = block_sides_[b].first_side;
    const size_t last = b + 1 < block_sides_.size() ? block_sides_[b + 1].first_side : side_.size();
    bool sends = false;
    for (size_t i = first; i < last; ++i) {
      sent_[i] = glm::vec4(glm::vec3(sent[side_[i]]), sent_[i].w);
      sends = sends || glm::vec3(sent_[i]) != glm::vec3(0.0f);
    }
    sends_[b] = sends ? 1 : 0;
  });
}

void OrdinatesTransportCpu::stream_in(const Sky* sky) {
  streams_in_ = sky != nullptr;
  if (sky != nullptr && sky->id() != inflow_of_) make_inflow(*sky);
}

/// The step kernel is handed the power of a cell, of which the upwind faces' shares are what comes in: the same cell
/// for all three. The characteristic one is handed the power through the face.
void OrdinatesTransportCpu::make_inflow(const Sky& sky) {
  inflow_of_ = sky.id();
  const OrdinateSet set = ordinate_set(choice_.directions);
  const size_t n = set.directions.size();
  const std::vector<glm::vec3> flux = rim_inflow(sky, set);
  inflow_.resize(batches_.size());
  for (size_t batch = 0; batch < batches_.size(); ++batch) {
    for (size_t octant = 0; octant < 8; ++octant) {
      std::array<Floats, 3>& by_axis = inflow_[batch][octant];
      for (Floats& lanes : by_axis) lanes.assign(sweep::kMaxLanes, 0.0f);
      for (const Lane& l : lanes_of(int(directions_in(set, batch)))) {
        const size_t d = batch * kBatch + l.direction;
        glm::vec3 handed = inflow_per_flux(set, d, voxels_.grid().cell_size_m) * flux[octant * n + d][l.band];
        if (choice_.rule == Ordinates::step) handed /= cell_transfer(choice_.rule, set.directions[d]).share[0];
        for (int axis = 0; axis < 3; ++axis) by_axis[size_t(axis)][size_t(l.lane)] = handed[axis];
      }
    }
  }
}

/// Planes of an octant's flow before its sweep: those across y and z of all rows.
void OrdinatesTransportCpu::fill_rim(int octant) {
  Flow& flow = flow_of(octant);
  const auto fill = [&](Floats& plane, std::vector<unsigned char>& lit, int axis) {
    std::fill(lit.begin(), lit.end(), static_cast<unsigned char>(1));
    for (size_t face = 0; face < lit.size(); ++face)
      kernels_.fill_face(constants().octets, inflow_[batch_][size_t(octant)][size_t(axis)].data(),
                         plane.data() + face * face_floats());
  };
  fill(flow.y, flow.y_lit, 1);
  fill(flow.z, flow.z_lit, 2);
}

bool OrdinatesTransportCpu::advance(std::span<glm::vec4> received, int /*max_passes*/, const BounceRules& /*rules*/,
                                    BounceReport& report) {
  assert(received.size() == voxels_.side_count());
  for (batch_ = 0; batch_ < batches_.size(); ++batch_) {
    // Octants do not depend on each other. Where threads share them evenly, rows of blocks need not be shared out.
    if (flows_.size() == 8) {
      const bool threaded = 8 % tbb::this_task_arena::max_concurrency() != 0;
      tbb::parallel_for(
          0, 8, [&](int octant) { sweep_octant(octant, threaded, nullptr); }, tbb::simple_partitioner());
    } else {
      for (int octant = 0; octant < 8; ++octant) sweep_octant(octant, true, nullptr);
    }
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
      glm::vec4& r = received[side_[i]];
      r = glm::vec4(glm::vec3(r) + (1.0f - sent_[i].w) * glm::vec3((a[0] + a[1]) + (a[2] + a[3])), r.w);
      std::fill(a, a + 4, glm::vec4(0.0f));
    }
  });
}

RadianceVolume OrdinatesTransportCpu::radiance(std::span<const glm::vec4> sent) {
  begin(sent);
  RadianceLeaves leaves(voxels_.blocks());
  // Octants add to the same cells: one after the other.
  for (batch_ = 0; batch_ < batches_.size(); ++batch_) {
    for (int octant = 0; octant < 8; ++octant) sweep_octant(octant, true, &leaves);
  }
  batch_ = 0;
  std::fill(arrived_.begin(), arrived_.end(), glm::vec4(0.0f));
  return std::move(leaves).volume(voxels_.grid());
}

/// Rows of blocks along x, by (y,z) along the flow; those of one diagonal y + z do not depend on each other.
void OrdinatesTransportCpu::sweep_octant(int octant, bool threaded, RadianceLeaves* leaves) {
  const glm::ivec3 n = voxels_.blocks();
  Flow& flow = flow_of(octant);
  std::fill(flow.y_lit.begin(), flow.y_lit.end(), static_cast<unsigned char>(0));
  std::fill(flow.z_lit.begin(), flow.z_lit.end(), static_cast<unsigned char>(0));
  if (streams_in_) fill_rim(octant);
  if (!threaded) {
    for (int z = 0; z < n.z; ++z) {
      for (int y = 0; y < n.y; ++y) sweep_row(octant, y, z, leaves);
    }
    return;
  }
  for (int diagonal = 0; diagonal <= n.y + n.z - 2; ++diagonal) {
    const int first = std::max(0, diagonal - (n.y - 1));
    const int last = std::min(n.z - 1, diagonal);
    tbb::parallel_for(first, last + 1, [&](int z) { sweep_row(octant, diagonal - z, z, leaves); });
  }
}

void OrdinatesTransportCpu::sweep_row(int octant, int y, int z, RadianceLeaves* leaves) {
  const FlushDenormals flush;
  const glm::ivec3 n = voxels_.blocks();
  const glm::ivec3 positive(octant & 1, (octant >> 1) & 1, octant >> 2);
  const size_t face = face_floats();
  Flow& flow = flow_of(octant);
  alignas(64) float x_carried[sweep::kBlockFace * sweep::kMaxLanes];
  unsigned char x_lit = streams_in_ ? 1 : 0;
  if (streams_in_) kernels_.fill_face(constants().octets, inflow_[batch_][size_t(octant)][0].data(), x_carried);
  const sweep::Kernel kernel =
      kernels_.kernel(choice_.rule == Ordinates::characteristic, constants().octets, leaves != nullptr);
  for (int x = 0; x < n.x; ++x) {
    const glm::ivec3 along(x, y, z);
    const glm::ivec3 block = positive * along + (1 - positive) * (n - 1 - along);
    const int sides = sides_of_block_[size_t(block_index(n, block))];
    const size_t by_y = size_t(x) + size_t(n.x) * size_t(z), by_z = size_t(x) + size_t(n.x) * size_t(y);
    unsigned char& y_lit = flow.y_lit[by_y];
    unsigned char& z_lit = flow.z_lit[by_z];
    if (x_lit == 0 && y_lit == 0 && z_lit == 0 && (sides < 0 || sends_[size_t(sides)] == 0)) continue;
    const glm::ivec3 extent = glm::min(glm::ivec3(kBlockCells), voxels_.grid().cells - kBlockCells * block);
    sweep::Block b{};
    b.x = x_carried;
    b.y = flow.y.data() + by_y * face;
    b.z = flow.z.data() + by_z * face;
    if (x_lit == 0) std::fill(b.x, b.x + face, 0.0f);
    if (y_lit == 0) std::fill(b.y, b.y + face, 0.0f);
    if (z_lit == 0) std::fill(b.z, b.z + face, 0.0f);
    for (int a = 0; a < 3; ++a) b.extent[a] = extent[a];
    b.octant = octant;
    if (sides >= 0) {
      const size_t first = block_sides_[size_t(sides)].first_side;
      b.sides = &block_sides_[size_t(sides)];
      b.sent = &sent_[first].x;
      b.arrived = &arrived_[4 * first].x;
    }
    if (leaves != nullptr) leaves->attach(b, n, block);
    kernel(constants(), b);
    x_lit = any_light(b.x, face) ? 1 : 0;
    y_lit = any_light(b.y, face) ? 1 : 0;
    z_lit = any_light(b.z, face) ? 1 : 0;
  }
}

size_t OrdinatesTransportCpu::bytes_for(const Grid& grid, OrdinateChoice choice, const ExpectedSides& expected) {
  const glm::ivec3 n = leaf_blocks(grid);
  const size_t flow = flow_bytes(n, face_floats(octets_of(std::min(choice.directions / 8, int(kBatch)))));
  return sizeof(OrdinatesTransportCpu) + expected.blocks * (sizeof(sweep::BlockSides) + 1) +
         size_t(n.x) * size_t(n.y) * size_t(n.z) * sizeof(int) +
         expected.sides * (sizeof(std::uint32_t) + 5 * sizeof(glm::vec4)) + flow_count(flow, kManyFlows) * flow;
}

size_t OrdinatesTransportCpu::bytes() const {
  size_t bytes = sizeof *this + block_sides_.size() * (sizeof(sweep::BlockSides) + 1) + sides_of_block_.size() * 4 +
                 side_.size() * (sizeof(std::uint32_t) + 5 * sizeof(glm::vec4));
  for (const Flow& flow : flows_) {
    bytes += (flow.y.size() + flow.z.size()) * sizeof(float) + flow.y_lit.size() + flow.z_lit.size();
  }
  return bytes;
}

}  // namespace volgi
