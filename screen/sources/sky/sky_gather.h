#pragma once
#include "core/gl/objects.h"
#include "core/gl/pass_timer.h"
#include "core/gl/program.h"
#include "screen/base/gbuffer.h"
#include "screen/base/named_texture.h"
#include "screen/base/smooth_pixels.h"
#include "screen/sources/sky/sky_maps.h"

namespace volgi::screen {

/// Pass "screen/sources/sky/sky_gather": light straight from the sky, all of its parts together, at the pixels that
/// need it (SmoothPixels). Those between two and between one pixel of others take every second part each, in turn: they
/// lie at edges, many of them beside one another. Cost a gathered pixel: a look into the map of each part above its
/// horizon. Interleaved by 4 x 4 and blurred instead, cornell's frame takes 1.2 times as long, with two thirds of this
/// error, but four times as large a worst one.
class SkyGather final : public SmoothLight {
 public:
  static constexpr const char* name = "screen/sources/sky/sky_gather";
  SkyGather(glm::ivec2 size, const SkyOptions& options);

  void run(const GBuffer& gbuffer, const SkyMaps& maps, gl::PassTimer& timer);
  std::vector<const gl::Texture*> radiance() const override { return {&radiance_}; }
  void gather(const WorkList& list, int step_px, std::span<const gl::Texture> irradiance,
              gl::PassTimer& timer) override;

  /// Share of the pixels that were gathered. Waits for the GPU; after a frame, not in one.
  double gathered_share() const { return pixels_.gathered_share(); }
  size_t bytes() const;
  void list_textures(std::vector<NamedTexture>& list) const {
    list_texture(list, name, "", radiance_);
    list_texture(list, name, "step", pixels_.gathered_step());
  }

 private:
  SmoothPixels pixels_;
  const SkyMaps* maps_ = nullptr;  // in run()
  gl::Texture radiance_;           // RGBA32F [W m^-2 sr^-1]
  gl::Program program_;
};

}  // namespace volgi::screen
