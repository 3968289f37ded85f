#pragma once
#include "core/gl/objects.h"
#include "core/gl/pass_timer.h"
#include "core/gl/program.h"
#include "propagation/radiance_volume_gl.h"
#include "screen/base/gbuffer.h"
#include "screen/base/named_texture.h"
#include "voxel/voxel_grid_gl.h"

namespace volgi::screen {

/// Pass "screen/bounces/volume/radiance_gather": light of the papers' volumes on every pixel, albedo/pi times the
/// irradiance that the spherical harmonics of the cells around a point half a cell in front of its surface give:
/// trilinear, clamped at zero. Nothing keeps light from behind a surface away but the half cell
/// (docs/theory.md#papers). Source: Kaplanyan 2009; Gaitatzes 2010 section 4.3. Cost: eight cells of 4 or 9 texels a
/// pixel.
class RadianceGather {
 public:
  static constexpr const char* name = "screen/bounces/volume/radiance_gather";
  /// @param sh_order  of the radiance: 1 or 2.
  explicit RadianceGather(glm::ivec2 size, int sh_order = 1);
  /// @param normal_occupancy  w > 0 where a cell takes part (gaitatzes2010), RGBA by cell; null: all do (lpv2009).
  void run(const GBuffer& gbuffer, const VoxelGridGl& voxels, const RadianceVolumeGl& radiance,
           const gl::Texture* normal_occupancy, gl::PassTimer& timer);

  const gl::Texture& direct() const { return direct_; }      // RGBA32F, black: these volumes do not know what is direct
  const gl::Texture& indirect() const { return indirect_; }  // RGBA32F [W m^-2 sr^-1]
  size_t bytes() const { return bytes_for(direct_.size()); }
  void list_textures(std::vector<NamedTexture>& list) const {
    list_texture(list, name, "direct", direct_);
    list_texture(list, name, "indirect", indirect_);
  }
  static size_t bytes_for(glm::ivec2 size) { return size_t(size.x) * size_t(size.y) * 2 * sizeof(glm::vec4); }

 private:
  gl::Texture direct_, indirect_;
  gl::Framebuffer framebuffer_;
  gl::Program program_;
};

}  // namespace volgi::screen
