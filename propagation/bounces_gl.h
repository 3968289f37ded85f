#pragma once
#include <memory>

#include "core/gl/pass_timer.h"
#include "core/gl/program.h"
#include "core/gl/readback.h"
#include "propagation/bounce_rules.h"
#include "propagation/side_flux_gl.h"
#include "propagation/transport_gl.h"

namespace volgi {

/// Applies a transport operator order by order: order k sends what sides return of order k-1. Timer
/// "propagation/propagate". Whether an order was the last is seen while the next one is under way, which then does not
/// count: the GPU never waits for the host, and the result does not depend on timing.
/// With rules.together() there is one order only, in which hits are sent on at once (iterative schemes).
class BouncesGl {
 public:
  explicit BouncesGl(std::unique_ptr<TransportGl> transport);

  /// @param flux  light in; emission starts first, so that its arrival (direct light) can be told apart.
  /// Says so on stderr when the estimate after the first order exceeds a minute.
  BounceReport run(const VoxelGridGl& voxels, const SideFluxGl& flux, bool has_emission, const BounceRules& rules,
                   gl::PassTimer& timer);

  const gl::Buffer& received_direct() const { return received_direct_; }  // emission's first arrival [W], vec4 a side
  const gl::Buffer& received_indirect() const { return received_indirect_; }  // all later arrivals [W]
  size_t bytes() const;

 private:
  void make_room(const VoxelGridGl& voxels);
  void next_order(const VoxelGridGl& voxels, const gl::Buffer& total, const gl::Buffer* source, bool already_reflected);
  void request_sent(const VoxelGridGl& voxels);

  std::unique_ptr<TransportGl> transport_;
  gl::Program next_order_, sum_sent_, sum_partials_;
  gl::Buffer received_, sent_, received_direct_, received_indirect_, sum_, partials_;
  gl::Readback readback_;
  std::uint32_t capacity_ = 0;
};

}  // namespace volgi
