#pragma once
#include "core/gl/objects.h"
#include "core/gl/pass_timer.h"
#include "core/gl/program.h"
#include "screen/base/gbuffer.h"
#include "screen/base/named_texture.h"
#include "voxel/voxel_grid_gl.h"

namespace volgi::screen {

/// Pass "screen/bounces/volume/volume_gather": the volume's light on every pixel, albedo/pi times the irradiance of the
/// sides of the cells in front of its surface: trilinear, like normals, never from behind a surface
/// (docs/theory.md#reconstruction). Cost: eight cells and their sides a pixel.
class VolumeGather {
 public:
  static constexpr const char* name = "screen/bounces/volume/volume_gather";
  explicit VolumeGather(glm::ivec2 size);
  /// @param direct_irradiance, indirect_irradiance  per side, vec4 [W m^-2]
  /// @param seeps  direct light may have come into sealed cells, by maps that have texels: a hundredth of what sides
  /// have in the mean counts as none, where a pixel looks for sides that show its surface.
  void run(const GBuffer& gbuffer, const Camera& camera, const VoxelGridGl& voxels, const gl::Buffer& direct_irradiance,
           const gl::Buffer& indirect_irradiance, bool seeps, gl::PassTimer& timer);

  const gl::Texture& direct() const { return direct_; }      // RGBA32F: first arrival of emission
  const gl::Texture& indirect() const { return indirect_; }  // RGBA32F [W m^-2 sr^-1]
  size_t bytes() const { return bytes_for(direct_.size()); }
  void list_textures(std::vector<NamedTexture>& list) const {
    list_texture(list, name, "direct", direct_);
    list_texture(list, name, "indirect", indirect_);
  }
  static size_t bytes_for(glm::ivec2 size) { return size_t(size.x) * size_t(size.y) * 2 * sizeof(glm::vec4); }

 private:
  gl::Texture direct_, indirect_;
  void sum(const gl::Buffer& irradiance) const;

  gl::Framebuffer framebuffer_;
  gl::Buffer sum_, partials_;  // over all sides: what is dim is judged by their mean
  gl::Program program_, sum_sides_, sum_partials_;
};

}  // namespace volgi::screen
