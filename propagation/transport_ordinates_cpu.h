#pragma once
#include <tbb/cache_aligned_allocator.h>

#include <array>
#include <optional>
#include <vector>

#include "propagation/ordinates.h"
#include "propagation/sweep/nested_faces.h"
#include "propagation/sweep/sweep_kernel.h"
#include "propagation/sweep/sweep_pipeline.h"
#include "propagation/transport_cpu.h"
#include "voxel/expected_sides.h"
#include "voxel/volume_sides.h"

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
/// registers) per octant, or, where eight would take more than SweepPipeline::kManyFlows, once: octants then take
/// turns, with the same answer (several ranks: sweep/sweep_pipeline.h); 84 bytes a side, 2.2 KiB a block with sides, 4
/// bytes a block. Twin: transport_ordinates_gl.cpp.
///
/// Of a cascade the same sweep goes through all grids at once: where a block's place has been taken by the next grid,
/// that grid's blocks there follow, and light passes the rim with its power kept (sweep/nested_faces.h). Faces are then
/// of several sizes: reciprocal is K over the receiving side's coverage and the area of its face. Memory is three
/// planes of each inner grid more an octant, of which two are under way where eight would take more than
/// kManyFlowsOfRank.
class OrdinatesTransportCpu : public TransportCpu {
 public:
  /// @param kernels  null: the fastest that this machine can run.
  /// @param ranks    that the voxels are parts of, which then do all together; null: there is one. No result depends
  ///                 on their number (sweep/sweep_pipeline.h).
  /// @param at_once  for tests.
  /// @param sources  of the orders that carry_sources() announces; none: `choice`. Of as many directions in a batch.
  /// @throws Error(usage) as ordinate_set.
  OrdinatesTransportCpu(const VoxelGrid& voxels, OrdinateChoice choice, const sweep::Kernels* kernels = nullptr,
                        const RanksOfVolume* ranks = nullptr, SweepPipeline::AtOnce at_once = {},
                        std::optional<OrdinateChoice> sources = {});
  /// Of a cascade, whose levels' sides follow each other (VolumeSides). Both must outlive this; one rank.
  OrdinatesTransportCpu(const Cascade& cascade, std::span<const VoxelGrid> levels, OrdinateChoice choice,
                        std::optional<OrdinateChoice> sources = {}, SweepPipeline::AtOnce at_once = {});

  void begin(std::span<const glm::vec4> sent) override;
  void stream_in(const Sky* sky) override;
  void carry_sources(bool on) override { of_sources_ = on; }
  void set_passages(std::span<const PassageFace> faces) override;
  bool advance(std::span<glm::vec4> received, int max_passes, const BounceRules& rules, BounceReport& report) override;
  bool iterative() const override { return false; }
  bool linear() const override { return true; }
  /// One more sweep, octant after octant. Cells that no light reached are inactive. Of one grid.
  RadianceVolume radiance(std::span<const glm::vec4> sent) override;
  size_t bytes() const override;
  /// What bytes() will be.
  static size_t bytes_for(const Grid& grid, OrdinateChoice choice, const ExpectedSides& expected);
  /// Of a cascade. @param expected  of all levels together.
  static size_t bytes_for(const Cascade& cascade, OrdinateChoice choice, const ExpectedSides& expected);
  /// Of a rank's part.
  static size_t bytes_for(const RanksOfVolume& ranks, OrdinateChoice choice, const ExpectedSides& expected);
  /// Of these, about what a column of blocks along x without any sides takes on lean ranks.
  static size_t bytes_of_column(OrdinateChoice choice);
  const SweepPipeline& pipeline() const { return pipeline_; }
  OrdinateChoice choice() const { return all_.choice; }

 private:
  using Floats = std::vector<float, tbb::cache_aligned_allocator<float>>;
  /// What blocks at the rim find where light comes in, by octant and axis: one row of lanes.
  using Inflow = std::array<std::array<Floats, 3>, 8>;
  /// Directions and their rule, in batches of up to 16 directions of an octant each, the most that kernels take: these
  /// go in turn.
  struct Angles {
    OrdinateChoice choice;
    std::vector<sweep::Constants> batches;
    std::vector<Inflow> inflow;   // by batch
    std::uint64_t inflow_of = 0;  // Sky::id() that inflow is made from
  };
  struct RadianceLeaves;
  /// A block on its turn: its level and place, and the light at its faces.
  struct Turn {
    size_t level;
    glm::ivec3 block;
    NestedFaces::Faces faces;
  };

  OrdinatesTransportCpu(const VolumeSides& sides, const Cascade* cascade, std::span<const VoxelGrid> levels,
                        OrdinateChoice choice, const sweep::Kernels* kernels, const RanksOfVolume* ranks,
                        SweepPipeline::AtOnce at_once, std::optional<OrdinateChoice> sources);
  void pack_sides(std::span<const PassageFace> passages);
  void sweep_turn(int octant, const Turn& turn, RadianceLeaves* leaves);
  void sweep_inside(int octant, const Turn& turn);
  static SweepPipeline::AtOnce with_inner_grids(const Cascade* cascade, size_t face_floats,
                                                SweepPipeline::AtOnce at_once);
  void make_inflow(const Sky& sky, Angles& angles) const;
  void fill_rim(SweepPipeline::Task task, int axis);
  void sweep(bool in_order, RadianceLeaves* leaves);
  void sweep_chunk(SweepPipeline::Task task, bool threaded, RadianceLeaves* leaves);
  void sweep_row(SweepPipeline::Task task, int y, int z, RadianceLeaves* leaves);
  static size_t bytes_of_sides(const BlockBox& part, const ExpectedSides& expected);
  static Angles make_angles(OrdinateChoice choice, float cell_size_m);
  const Angles& angles() const { return of_sources_ && sources_ ? *sources_ : all_; }
  void add_arrived(std::span<glm::vec4> received);
  const sweep::Constants& constants() const { return angles().batches[batch_]; }
  size_t face_floats() const { return face_floats(all_.batches[0].octets); }
  static size_t face_floats(int octets) { return sweep::kBlockFace * size_t(octets) * sweep::kOctet; }

  VolumeSides all_sides_;
  const VoxelGrid& voxels_;  // the outermost grid, or the only one
  const Cascade* cascade_;   // null: one grid
  sweep::Kernels kernels_;
  Angles all_;
  std::optional<Angles> sources_;
  bool of_sources_ = false;
  size_t batch_ = 0;  // of angles(), that is swept
  SweepPipeline pipeline_;
  std::optional<NestedFaces> nested_;  // of a cascade
  bool streams_in_ = false;
  // Sides in the order of blocks, so that those of a block lie together; side_[i] is the side's number in all_sides_.
  // Faces of passages are packed as sides, too, that send nothing and keep nothing: kNoSide.
  std::vector<sweep::BlockSides> block_sides_;
  std::vector<std::vector<int>> sides_of_block_;  // by level, of the part: index into block_sides_, or -1
  std::vector<unsigned char> sends_;              // by block_sides_: whether any side of the block sends
  std::vector<std::uint32_t> side_;
  std::vector<glm::vec4, tbb::cache_aligned_allocator<glm::vec4>> sent_;     // w: 1 - tau
  std::vector<glm::vec4, tbb::cache_aligned_allocator<glm::vec4>> arrived_;  // 4 a side, zero between sweeps
};

}  // namespace volgi
