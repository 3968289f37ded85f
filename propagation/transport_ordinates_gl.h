#pragma once
#include "core/gl/program.h"
#include "propagation/ordinates.h"
#include "propagation/transport_gl.h"

namespace volgi {

/// `ordinates`: the discrete-ordinates (S_N) method of neutron transport, step scheme. The power of direction d in a
/// cell leaves through its three downwind faces in proportion to |d_x|, |d_y|, |d_z|; one sweep per octant solves an
/// order exactly. Conserves, is positive, linear and reciprocal: lights superpose. Lateral spread stands in for the
/// directions between (docs/theory.md#ordinates, with what it cannot do: narrow ducts, sharp first bounces). Cost of an
/// order: one visit of each cell per octant in x+y+z-2 dispatches; a few additions per direction and band. Memory: two
/// diagonal planes per octant, and 64 bytes a side.
class OrdinatesTransportGl : public TransportGl {
 public:
  /// @throws Error(usage) as ordinate_set.
  OrdinatesTransportGl(const Grid& grid, int directions);
  void carry(const VoxelGridGl& voxels, const gl::Buffer& sent, const gl::Buffer& received, const BounceRules& rules,
             BounceReport& report) override;
  bool iterative() const override { return false; }
  size_t bytes() const override;

 private:
  OrdinateSet set_;
  gl::Program sweep_, collect_;
  gl::Texture planes_[2];  // RGBA32F, columns x 8 octants of directions
  gl::Buffer arrived_;
  Grid grid_{};
  std::uint32_t capacity_ = 0;
};

}  // namespace volgi
