#pragma once
#include <array>
#include <optional>

#include "core/gl/objects.h"
#include "core/gl/pass_timer.h"
#include "core/gl/program.h"
#include "propagation/bounces_cpu.h"
#include "screen/base/gbuffer.h"
#include "screen/base/named_texture.h"
#include "screen/base/smooth_pixels.h"
#include "voxel/voxel_grid_gl.h"

namespace volgi::screen {

/// Pass "screen/bounces/volume/volume_gather": the volume's light on every pixel, albedo/pi times the irradiance of the
/// sides of the cells in front of its surface: trilinear, like normals, never from behind a surface
/// (docs/theory.md#reconstruction). Cost: eight cells and their sides a pixel that is gathered: every one, or with
/// other smooth light those that need it (SmoothPixels).
class VolumeGather : private SmoothLight {
 public:
  static constexpr const char* name = "screen/bounces/volume/volume_gather";
  explicit VolumeGather(glm::ivec2 size);
  /// The volume that pixels are lit by, in one frame.
  struct Volume {
    const VoxelGridGl& voxels;
    const gl::Buffer& direct_irradiance;  // per side, vec4 [W m^-2]
    const gl::Buffer& indirect_irradiance;
    bool direct_is_apart = true;  // false: nothing is in direct_irradiance, and direct() stays as it is
  };
  /// @param with  other smooth light, gathered together with this at the pixels that need it; null: every pixel.
  void run(const GBuffer& gbuffer, const Camera& camera, const Volume& volume, const SmoothGather* with,
           gl::PassTimer& timer);
  /// The same of every pixel on the CPU (propagation/pixel_irradiance_cpu.h), for sides that are too many for buffers
  /// of the GPU; other smooth light is gathered by itself. Waits for the G-buffer.
  /// Of nested grids too. @param irradiance  by level.
  void run_on_cpu(const GBuffer& gbuffer, const Camera& camera, const VolumeSides& sides,
                  std::span<const SideIrradiance> irradiance, const SmoothGather* with, gl::PassTimer& timer);

  const gl::Texture& direct() const { return direct_; }      // RGBA32F: first arrival of emission
  const gl::Texture& indirect() const { return indirect_; }  // RGBA32F [W m^-2 sr^-1]
  size_t bytes() const { return bytes_for(direct_.size()); }
  void list_textures(std::vector<NamedTexture>& list) const {
    list_texture(list, name, "direct", direct_);
    list_texture(list, name, "indirect", indirect_);
  }
  static size_t bytes_for(glm::ivec2 size) { return size_t(size.x) * size_t(size.y) * 2 * sizeof(glm::vec4); }

 private:
  std::vector<const gl::Texture*> radiance() const override;
  void gather(const WorkList& list, int /*step_px*/, std::span<const gl::Texture> irradiance,
              gl::PassTimer& timer) override;
  void draw(const GBuffer& gbuffer, gl::PassTimer& timer);
  void look_from(const Camera& camera);
  void bind_volume(const gl::Program& program) const;

  gl::Texture direct_, indirect_;
  gl::Framebuffer framebuffer_;
  gl::Program program_;
  std::array<std::optional<gl::Program>, 2> listed_;  // without and with direct light
  const Volume* volume_ = nullptr;                    // within run()
  glm::vec4 viewer_{0.0f};
};

}  // namespace volgi::screen
