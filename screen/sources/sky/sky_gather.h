#pragma once
#include <optional>

#include "core/gl/objects.h"
#include "core/gl/pass_timer.h"
#include "core/gl/program.h"
#include "screen/base/gbuffer.h"
#include "screen/base/named_texture.h"
#include "screen/gather/interleaved/geometry_blur.h"
#include "screen/gather/interleaved/worst_pixels.h"
#include "screen/sources/sky/sky_maps.h"

namespace volgi::screen {

/// Passes "screen/sources/sky/sky_gather" and "screen/sources/sky/exact_pixels": light straight from the sky on every
/// pixel. Pixels of a block of n x n share the sky's parts, and a blur that does not cross edges of geometry joins
/// them; those that may err most take all parts. Cost a pixel: parts / n^2 looks into maps, and the blur's 6 n - 3
/// texels.
class SkyGather {
 public:
  static constexpr const char* name = "screen/sources/sky/sky_gather";
  static constexpr const char* exact_name = "screen/sources/sky/exact_pixels";
  /// @throws Error(usage) when options.interleave is not 1, 2, 4 or 8.
  SkyGather(glm::ivec2 size, const SkyOptions& options);
  /// @param sample  FrameData::sample: every pixel of a block takes the next subset, in n^2 of them each.
  void run(const GBuffer& gbuffer, const SkyMaps& maps, float scene_diagonal_m, gl::PassTimer& timer, int sample = 0);

  const gl::Texture& radiance() const { return radiance_; }  // RGBA32F [W m^-2 sr^-1]
  size_t bytes() const;
  void list_textures(std::vector<NamedTexture>& list) const {
    list_texture(list, name, "irradiance", irradiance_);
    if (blur_) list_texture(list, name, "error estimate", blur_->error_estimate());
    list_texture(list, exact_name, "", radiance_);
  }

 private:
  void gather(const SkyMaps& maps, int sample);
  void gather_again(const SkyMaps& maps);

  glm::ivec2 size_;
  SkyOptions options_;
  gl::Texture radiance_, irradiance_;
  // None where every pixel takes every part.
  std::optional<GeometryBlur> blur_;
  std::optional<WorstPixels> worst_;
  gl::Program gather_, gather_listed_;
};

}  // namespace volgi::screen
