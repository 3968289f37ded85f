#pragma once
#include "core/gl/pass_timer.h"
#include "core/gl/program.h"
#include "propagation/bounces_gl.h"

namespace volgi {

/// Irradiance per side [W m^-2] from the power that sides have received, timer "propagation/side_irradiance":
/// E of side_irradiance() (docs/theory.md#sides), then the area-weighted mean over the sides with normals within
/// 45 degrees in the 3^3 cells around that can be reached without crossing a surface, then clamped at zero.
class SideIrradianceGl {
 public:
  SideIrradianceGl();
  void run(const VoxelGridGl& voxels, const SideFluxGl& flux, const BouncesGl& bounces, gl::PassTimer& timer) {
    run(voxels, flux, bounces.received_direct(), bounces.received_indirect(), timer);
  }
  /// @param direct  received power [W], vec4 a side. @param indirect  alike.
  void run(const VoxelGridGl& voxels, const SideFluxGl& flux, const gl::Buffer& direct, const gl::Buffer& indirect,
           gl::PassTimer& timer);

  const gl::Buffer& direct() const { return direct_; }      // emission's first arrival; vec4 a side
  const gl::Buffer& indirect() const { return indirect_; }  // everything after
  size_t bytes() const;
  static size_t bytes_for(std::uint32_t side_capacity);

 private:
  gl::Program side_irradiance_, smooth_;
  gl::Buffer raw_direct_, raw_indirect_, direct_, indirect_;
  std::uint32_t capacity_ = 0;
};

}  // namespace volgi
