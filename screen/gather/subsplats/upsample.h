#pragma once
#include "core/camera.h"
#include "core/gl/objects.h"
#include "core/gl/pass_timer.h"
#include "core/gl/program.h"
#include "screen/base/gbuffer.h"
#include "screen/gather/subsplats/subsplat_levels.h"

namespace volgi::screen {

struct UpsampleOptions {
  /// printed: every texel of a level is interpolated with those around it (Nichols 2010, §3.2.5), those that were
  /// rendered too, which takes light one texel across the finest edges. kept: those stay as they are; ours.
  enum class Rendered { printed, kept } rendered = Rendered::kept;
  float detail = 0.0f;  // alpha of eq. 3.3: modulation by how much the surface faces the viewer
};

/// Pass "screen/gather/subsplats/upsample": one picture of the flattened buffer's levels, from the coarsest to the
/// finest: each takes what the coarser one gives it between the 3 x 3 texels around that hold data. Ends in radiance at
/// every pixel; albedo comes last, so that textures stay sharp (in the thesis fragments have it). Cost: 9 texels a
/// texel.
class Upsample {
 public:
  static constexpr const char* name = "screen/gather/subsplats/upsample";
  Upsample(const SubsplatLevels& levels, const UpsampleOptions& options);

  /// @param rendered  FlattenedBuffer::irradiance().
  void run(const GBuffer& gbuffer, const Camera& camera, const gl::Texture& rendered, gl::PassTimer& timer);

  const gl::Texture& radiance() const { return radiance_; }  // RGBA32F [W m^-2 sr^-1]
  size_t bytes() const;

 private:
  SubsplatLevels levels_;
  UpsampleOptions options_;
  gl::Texture upsampled_, radiance_;
  gl::Program level_, pixels_;
};

}  // namespace volgi::screen
