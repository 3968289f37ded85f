#pragma once
#include "core/gl/objects.h"
#include "core/gl/pass_timer.h"
#include "core/gl/program.h"
#include "propagation/side_irradiance_gl.h"
#include "screen/gbuffer.h"

namespace volgi::screen {

/// Pass "screen/volume_gather": the volume's light on every pixel, albedo/pi times the irradiance of the sides of the
/// cells in front of its surface: trilinear, like normals, never from behind a surface (docs/theory.md#reconstruction).
/// Cost: eight cells and their sides a pixel.
class VolumeGather {
 public:
  static constexpr const char* name = "screen/volume_gather";
  explicit VolumeGather(glm::ivec2 size);
  void run(const GBuffer& gbuffer, const Camera& camera, const VoxelGridGl& voxels, const SideIrradianceGl& irradiance,
           gl::PassTimer& timer);

  const gl::Texture& direct() const { return direct_; }      // RGBA32F: first arrival of emission
  const gl::Texture& indirect() const { return indirect_; }  // RGBA32F [W m^-2 sr^-1]
  size_t bytes() const { return size_t(direct_.size().x) * size_t(direct_.size().y) * 32; }

 private:
  gl::Texture direct_, indirect_;
  gl::Framebuffer framebuffer_;
  gl::Program program_;
};

}  // namespace volgi::screen
