#pragma once
#include "core/sky.h"
#include "propagation/bounce_rules.h"
#include "propagation/radiance_volume_gl.h"
#include "voxel/voxel_grid_gl.h"

namespace volgi {

class ResumableGl;

/// A scheme: the operator that carries the power which sides send through the grid until sides receive it or it leaves.
class TransportGl {
 public:
  virtual ~TransportGl() = default;
  /// One order.
  /// @param sent      power per side (vec4, rgb) [W], >= 0.
  /// @param received  power per side (vec4, rgb) [W], added to.
  /// @param report    passes, and power that was left in flight, are added.
  virtual void carry(const VoxelGridGl& voxels, const gl::Buffer& sent, const gl::Buffer& received,
                     const BounceRules& rules, BounceReport& report) = 0;
  /// As TransportCpu::stream_in.
  virtual void stream_in(const Sky* /*sky*/) {}
  /// As TransportCpu::carry_sources.
  virtual void carry_sources(bool /*on*/) {}
  /// Radiance that `sent` (all orders together) makes in free space.
  virtual RadianceVolumeGl radiance(const VoxelGridGl& voxels, const gl::Buffer& sent) = 0;
  /// Whether an order takes a number of passes that rules.iterations can set.
  virtual bool iterative() const = 0;
  /// What carries orders on in parts; null where an order cannot stop in between.
  virtual ResumableGl* resumable() { return nullptr; }
  virtual size_t bytes() const = 0;
};

}  // namespace volgi
