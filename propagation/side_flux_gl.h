#pragma once
#include <vector>

#include "core/gl/pass_timer.h"
#include "core/gl/program.h"
#include "core/light.h"
#include "voxel/voxel_grid_gl.h"

namespace volgi {

/// What lit and emissive surfaces send before any transport, as flux A·B0 per side [W] (vec4, rgb): light in.
/// Sources are deposited one after another in 64-bit fixed point (propagation/fixed_flux.glsl), each with its own unit,
/// so that the sum over sides and `lost` is the sum over the source's samples to rounding of floats, however little of
/// the power each of them brings, and in any order of threads.
class SideFluxGl {
 public:
  SideFluxGl();

  /// Makes room for the grid's sides and sets all flux to zero.
  void begin(const VoxelGridGl& voxels);
  /// Binds everything that deposit.glsl needs and sets `source_power` of `program`: the source deposits at most that
  /// many watts per band. Then dispatch, then collect() into the buffer that the source belongs to.
  void begin_source(const VoxelGridGl& voxels, const gl::Program& program, float source_power);
  void collect(const VoxelGridGl& voxels, const gl::Buffer& into);
  /// Emissive surfaces (voxel/emitter_pieces.h), timer "propagation/inject_emitters". @param apart  kept in emitted();
  /// else with the punctual light, for schemes that cannot tell them apart.
  void inject_emitters(const VoxelGridGl& voxels, const std::vector<FluxSample>& pieces, gl::PassTimer& timer,
                       bool apart = true);

  const gl::Buffer& emitted() const { return emitted_; }    // emission: its first arrival is direct light
  const gl::Buffer& punctual() const { return punctual_; }  // reflected light of punctual sources
  /// Flux that found no side anywhere near [W], for statistics. Waits for the GPU.
  glm::vec3 lost() const;
  size_t bytes() const;
  /// What bytes() will be. @param pieces  of emitters.
  static size_t bytes_for(std::uint32_t side_capacity, size_t pieces);

 private:
  gl::Program inject_emitters_;
  gl::Program collect_;
  gl::Buffer emitted_, punctual_, fixed_, fixed_lost_, lost_, pieces_;
  std::uint32_t capacity_ = 0;
  float source_power_ = 1.0f;
};

}  // namespace volgi
