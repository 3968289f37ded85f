#pragma once
#include <tbb/cache_aligned_allocator.h>

#include <array>
#include <vector>

#include "propagation/ordinates.h"
#include "propagation/sweep/sweep_kernel.h"
#include "propagation/transport_cpu.h"
#include "voxel/expected_sides.h"

namespace volgi {

/// `ordinates`: the discrete-ordinates (S_N) method of neutron transport, step or step-characteristic (SC1) rule. One
/// sweep per octant, upwind cells first, solves an order exactly: void, blocked and partly transmitting faces
/// (docs/theory.md#ordinates). Linear, reciprocal, never negative; power is kept to rounding.
///
/// Cells are taken in blocks of 8^3, the leaves of the voxels. A block that no light enters and that no side sends from
/// is skipped; rows of cells without sides run through a loop of three (step) or nine (SC1) multiplications a lane.
/// Values below 2^-126 W count as zero. Cost of an order: one visit of each cell that light reaches per octant. Threads
/// take octants, and diagonals of rows of blocks where that is not even; every sum has a fixed order.
/// Memory: two planes of the grid (4 bytes x lanes a cell of them, 3 lanes a direction of an octant and a few to fill
/// registers) per octant, or, where eight would take more than kManyFlows, once: octants then take turns, with the same
/// answer; 84 bytes a side, 2.2 KiB a block with sides, 4 bytes a block. Twin: transport_ordinates_gl.cpp.
class OrdinatesTransportCpu : public TransportCpu {
 public:
  static constexpr size_t kManyFlows = size_t(128) << 20;  // bytes

  /// @param kernels  null: the fastest that this machine can run. @param many_flows  for tests, in place of kManyFlows.
  /// @throws Error(usage) as ordinate_set.
  OrdinatesTransportCpu(const VoxelGrid& voxels, OrdinateChoice choice, const sweep::Kernels* kernels = nullptr,
                        size_t many_flows = kManyFlows);

  void begin(std::span<const glm::vec4> sent) override;
  void stream_in(const Sky* sky) override;
  bool advance(std::span<glm::vec4> received, int max_passes, const BounceRules& rules, BounceReport& report) override;
  bool iterative() const override { return false; }
  bool linear() const override { return true; }
  /// One more sweep, octant after octant. Cells that no light reached are inactive.
  RadianceVolume radiance(std::span<const glm::vec4> sent) override;
  size_t bytes() const override;
  /// What bytes() will be.
  static size_t bytes_for(const Grid& grid, OrdinateChoice choice, const ExpectedSides& expected);
  OrdinateChoice choice() const { return choice_; }

 private:
  using Floats = std::vector<float, tbb::cache_aligned_allocator<float>>;
  /// Light between blocks of one octant, by block along the flow: through y by (x,z), through z by (x,y). That through
  /// x stays inside a row of blocks. `lit` says where there is any; elsewhere the values are of no meaning.
  struct Flow {
    Floats y, z;
    std::vector<unsigned char> y_lit, z_lit;
  };
  struct RadianceLeaves;

  void pack_sides();
  Flow& flow_of(int octant) { return flows_[flows_.size() == 8 ? size_t(octant) : 0]; }
  void make_inflow(const Sky& sky);
  void fill_rim(int octant);
  void add_arrived(std::span<glm::vec4> received);
  void sweep_octant(int octant, bool threaded, RadianceLeaves* leaves);
  void sweep_row(int octant, int y, int z, RadianceLeaves* leaves);
  const sweep::Constants& constants() const { return batches_[batch_]; }
  size_t face_floats() const { return face_floats(batches_[0].octets); }
  static size_t face_floats(int octets) { return sweep::kBlockFace * size_t(octets) * sweep::kOctet; }

  const VoxelGrid& voxels_;
  OrdinateChoice choice_;
  sweep::Kernels kernels_;
  /// Up to 16 directions of an octant each, the most that kernels take: larger sets go in turn. `batch_` is swept.
  std::vector<sweep::Constants> batches_;
  size_t batch_ = 0;
  std::vector<Flow> flows_;  // of each octant, or of the one whose turn it is
  /// What blocks at the rim find where light comes in, by octant and axis, of each batch: one row of lanes.
  using Inflow = std::array<std::array<Floats, 3>, 8>;
  std::vector<Inflow> inflow_;
  std::uint64_t inflow_of_ = 0;  // Sky::id() that inflow_ is made from
  bool streams_in_ = false;
  // Sides in the order of blocks, so that those of a block lie together; side_[i] is the side's number in voxels_.
  std::vector<sweep::BlockSides> block_sides_;
  std::vector<int> sides_of_block_;   // index into block_sides_, or -1
  std::vector<unsigned char> sends_;  // by block_sides_: whether any side of the block sends
  std::vector<std::uint32_t> side_;
  std::vector<glm::vec4, tbb::cache_aligned_allocator<glm::vec4>> sent_;     // w: 1 - tau
  std::vector<glm::vec4, tbb::cache_aligned_allocator<glm::vec4>> arrived_;  // 4 a side, zero between sweeps
};

}  // namespace volgi
