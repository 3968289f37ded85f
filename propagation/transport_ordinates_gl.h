#pragma once
#include <memory>
#include <optional>
#include <vector>

#include "core/gl/objects.h"
#include "core/gl/program.h"
#include "propagation/ordinates.h"
#include "propagation/scheme.h"
#include "propagation/sweep_radiance_gl.h"
#include "propagation/transport_gl.h"

namespace volgi {

/// `ordinates`: the discrete-ordinates (S_N) method of neutron transport. Every cell holds a power per direction; it
/// leaves through the downwind faces by the step or the characteristic rule (ordinates.h, cell_transfer), and one sweep
/// per octant solves an order exactly. Conserves, is positive, linear and reciprocal: lights superpose. Lateral spread
/// stands in for the directions between (docs/theory.md#ordinates, with what it cannot do: narrow ducts, sharp first
/// bounces). Cost of an order: one visit of each cell per octant, in (x+y+z)/8 - 2 dispatches, a diagonal of
/// blocks of 8^3 cells each;
/// an invocation walks through a block with four directions of a band, and reads and writes 5 texels for every 8 cells.
/// Memory: a plane of the grid across each axis, 16 bytes for four directions of a band; 4 bytes a cell; 16 bytes a
/// side, and 16 more for every four directions of an octant and each band.
class OrdinatesTransportGl : public TransportGl {
 public:
  /// Directions and rule by choose_ordinates. @throws Error(usage) as ordinate_set.
  OrdinatesTransportGl(const Grid& grid, const SchemeOptions& options);
  OrdinatesTransportGl(const Grid& grid, int directions, Ordinates rule = Ordinates::step);
  /// @param sources  of the orders that carry_sources() announces; none: `choice`.
  OrdinatesTransportGl(const Grid& grid, OrdinateChoice choice, std::optional<OrdinateChoice> sources);

  void carry(const VoxelGridGl& voxels, const gl::Buffer& sent, const gl::Buffer& received, const BounceRules& rules,
             BounceReport& report) override;
  void stream_in(const Sky* sky) override;
  void carry_sources(bool on) override;
  /// Of what sides send: the sky's own light is not in it.
  RadianceVolumeGl radiance(const VoxelGridGl& voxels, const gl::Buffer& sent) override;
  bool iterative() const override { return false; }
  size_t bytes() const override;
  /// What bytes() will be.
  static size_t bytes_for(const Grid& grid, OrdinateChoice choice, std::uint32_t side_capacity);
  /// What carry() must move at least [bytes]: what passes between tiles through the planes, read and written; each
  /// cell's word once an octant; each side's light once for each of the four octants that can leave it, and what they
  /// bring to it, written and then read. Invocations of a work group that read the same word count as one.
  static size_t moved_bytes_for(const Grid& grid, OrdinateChoice choice, size_t sides);
  /// Dispatches of an order's sweep.
  int dispatches() const { return int(first_block_.size()) - 1; }

 private:
  void list_blocks();
  void prepare(const VoxelGridGl& voxels, const gl::Buffer& sent);
  void sweep(size_t batch);
  /// Directions and their rule, in batches of as many as invocations take at once.
  struct Angles {
    OrdinateChoice choice;
    gl::Program sweep;
    std::vector<gl::Buffer> shares, inflow;  // by batch
    std::uint64_t inflow_of = 0;             // Sky::id() that inflow is made from
  };
  Angles make_angles(OrdinateChoice choice) const;
  void make_inflow(const Sky& sky, Angles& angles) const;
  Angles& angles() { return of_sources_ && sources_ ? *sources_ : all_; }

  Grid grid_{};
  OrdinateChoice choice_;
  int lanes_;  // invocations of one block and octant: three bands of as many quads of directions
  gl::Program prepare_, collect_;
  Angles all_;
  std::optional<Angles> sources_;
  bool of_sources_ = false;
  std::unique_ptr<SweepRadianceGl> read_out_;  // made on first use
  bool streams_in_ = false;
  gl::Texture faces_[3];                          // by axis: what leaves cells through downwind faces
  gl::Texture cell_word_, side_light_, arrived_;  // prepare_sweep.comp.glsl, sweep.comp.glsl
  gl::Texture block_list_;
  std::vector<int> first_block_;  // of each diagonal in block_list_, and their end
  std::uint32_t capacity_ = 0;
};

}  // namespace volgi
