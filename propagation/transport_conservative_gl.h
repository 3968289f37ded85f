#pragma once
#include <optional>

#include "core/gl/objects.h"
#include "core/gl/program.h"
#include "core/gl/readback.h"
#include "propagation/resumable_gl.h"
#include "propagation/transport_gl.h"

namespace volgi {

/// `conservative`: power that sides send goes through the grid as lobes of spherical harmonics, one cell a pass, as a
/// pulse: sent once, hits added up until the power in flight is small enough.
///
/// A cell's lobe leaves through a face by the exact flux there of the radiance that it stands for, clamped at zero and
/// rescaled so that the six sum to its power; what is handed on is that flux projected. In void the power is kept to
/// rounding; no face passes and no side receives negative power; isotropic light is a fixed point
/// (docs/theory.md#conservative). Not linear: clamp and rescale. Cost of a pass: 21 texel reads and 3 writes of 16
/// bytes a cell (49 and 7 for order 2). Memory: 96 bytes a cell (224). The host looks at the power in flight one batch
/// of passes late, so the GPU never runs dry; the number of passes does not depend on timing. Source: Gaitatzes 2010
/// section 4.2; Kaplanyan 2009. We depart: fluxes through faces for cones, power kept, sides.
class ConservativeTransportGl : public TransportGl, public ResumableGl {
 public:
  /// @param sh_order  1 or 2.
  explicit ConservativeTransportGl(const Grid& grid, int sh_order = 1);
  void carry(const VoxelGridGl& voxels, const gl::Buffer& sent, const gl::Buffer& received, const BounceRules& rules,
             BounceReport& report) override;
  void begin_order(const VoxelGridGl& voxels, const gl::Buffer& sent) override;
  bool advance_order(const VoxelGridGl& voxels, const gl::Buffer& received, int max_passes_now,
                     const BounceRules& rules, BounceReport& report) override;
  RadianceVolumeGl radiance(const VoxelGridGl& voxels, const gl::Buffer& sent) override;
  bool iterative() const override { return true; }
  ResumableGl* resumable() override { return this; }
  size_t bytes() const override { return bytes_for(grid_, order_); }
  static size_t bytes_for(const Grid& grid, int sh_order);

  // The parts of carry(), for tests.
  void emit(const VoxelGridGl& voxels, const gl::Buffer& sent);
  void advance(const VoxelGridGl& voxels, const gl::Buffer& received, int passes, bool reflect_hits);
  /// Power in flight per band [W]; waits for the GPU.
  glm::vec3 in_flight(const VoxelGridGl& voxels);

 private:
  void make_lobes();
  void sum_in_flight(const VoxelGridGl& voxels);
  void request_in_flight(const VoxelGridGl& voxels);
  glm::vec3 pop_in_flight();

  gl::Program compile(const char* shader) const;
  int order_;
  gl::Program emit_, propagate_, sum_lobes_, sum_partials_;
  std::optional<gl::Program> add_radiance_;  // compiled on first use
  gl::Texture lobes_[2];                     // RGBA32F, parts of the three bands' lobes stacked in z
  gl::Buffer partials_, sum_;
  gl::Readback readback_;
  Grid grid_{};
  int current_ = 0;
  int passes_ = 0;         // of the order
  glm::vec3 start_{0.0f};  // power in flight when it began [W]
};

}  // namespace volgi
