#pragma once
#include "core/gl/objects.h"
#include "core/gl/program.h"
#include "core/gl/readback.h"
#include "propagation/transport_gl.h"

namespace volgi {

/// `conservative`: power that sides send goes through the grid as SH-1 lobes, one cell a pass, as a pulse: sent once,
/// hits added up until the power in flight is small enough.
///
/// A cell's lobe leaves through face f by its integral over the face's exact 90-degree pyramid, clamped at zero and
/// rescaled so that the six sum to its power; what is handed on is the projection of the lobe cut at that pyramid.
/// In void the power is kept to rounding; no face passes and no side receives negative power; isotropic light is a
/// fixed point (docs/theory.md#conservative). Not linear: clamp and rescale. Cost of a pass: 21 texel reads and 3
/// writes of 16 bytes a cell. Memory: 96 bytes a cell. The host looks at the power in flight one batch of passes late,
/// so the GPU never runs dry; the number of passes does not depend on timing. Source: Gaitatzes 2010 section 4.2;
/// Kaplanyan 2009. We depart: pyramids for cones, power kept, sides.
class ConservativeTransportGl : public TransportGl {
 public:
  explicit ConservativeTransportGl(const Grid& grid);
  void carry(const VoxelGridGl& voxels, const gl::Buffer& sent, const gl::Buffer& received, const BounceRules& rules,
             BounceReport& report) override;
  bool iterative() const override { return true; }
  size_t bytes() const override;

  // The parts of carry(), for tests.
  void emit(const VoxelGridGl& voxels, const gl::Buffer& sent);
  void advance(const VoxelGridGl& voxels, const gl::Buffer& received, int passes, bool reflect_hits);
  /// Power in flight per band [W]; waits for the GPU.
  glm::vec3 in_flight(const VoxelGridGl& voxels);

 private:
  void request_in_flight(const VoxelGridGl& voxels);
  glm::vec3 pop_in_flight();

  gl::Program emit_, propagate_, sum_in_flight_, sum_partials_;
  gl::Texture lobes_[2];  // RGBA32F, three bands stacked in z
  gl::Buffer partials_, sum_;
  gl::Readback readback_;
  Grid grid_{};
  int current_ = 0;
};

}  // namespace volgi
