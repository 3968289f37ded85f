#pragma once
#include "propagation/bounce_rules.h"
#include "voxel/voxel_grid_gl.h"

namespace volgi {

/// What a TransportGl whose orders take many passes is, too, when an order can stop between two of them and go on
/// later: amortised runs (BounceRules::passes_per_run) ask for it. Twin of TransportCpu::begin and advance.
class ResumableGl {
 public:
  virtual ~ResumableGl() = default;
  /// Starts an order. @param sent  power per side (vec4, rgb) [W], >= 0.
  virtual void begin_order(const VoxelGridGl& voxels, const gl::Buffer& sent) = 0;
  /// Carries it on by at most `max_passes` passes.
  /// @param received  power per side (vec4, rgb) [W], added to.
  /// @param report    passes are added, and, when the order ends, the power that was left in flight.
  /// @return whether the order has ended.
  virtual bool advance_order(const VoxelGridGl& voxels, const gl::Buffer& received, int max_passes,
                             const BounceRules& rules, BounceReport& report) = 0;
};

}  // namespace volgi
