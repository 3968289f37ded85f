#pragma once
#include "core/gl/objects.h"
#include "core/gl/pass_timer.h"
#include "core/gl/program.h"
#include "screen/base/gbuffer.h"
#include "screen/gather/subsplats/discontinuity_mipmaps.h"
#include "screen/gather/subsplats/subsplat_levels.h"

namespace volgi::screen {

/// The flattened multiresolution buffer: irradiance of the subsplats of all levels beside one another, and a stencil of
/// where they are. Light is added to it, by draws that pass the stencil test or as points.
class FlattenedBuffer {
 public:
  static constexpr const char* mark_name = "screen/gather/subsplats/mark_fragments";
  explicit FlattenedBuffer(const SubsplatLevels& levels);

  void clear() const;
  /// Pass "screen/gather/subsplats/mark_fragments": sets the stencil where the picture's fragments are, all levels in
  /// one pass (Nichols 2010, §4.2.1.1). Cost: a look at the mipmaps for every texel.
  void mark(const GBuffer& gbuffer, const DiscontinuityMipmaps& mipmaps, gl::PassTimer& timer) const;

  /// Draws from now on add to what is there, or take from it.
  enum class Draw { adds, subtracts };
  void begin(Draw draw) const;
  /// One over all of it, where the stencil has been set.
  void draw_marked() const;

  const SubsplatLevels& levels() const { return levels_; }
  const gl::Texture& irradiance() const { return irradiance_; }  // RGBA32F [W m^-2]; w > 0 where there is a fragment
  /// Fragments with light. Waits for the GPU; after a frame, not in one.
  size_t fragments() const;
  size_t bytes() const { return (16 + 4) * size_t(levels_.flattened().x) * size_t(levels_.flattened().y); }

 private:
  SubsplatLevels levels_;
  gl::Texture irradiance_, stencil_;
  gl::Framebuffer framebuffer_;
  gl::Program mark_;
};

}  // namespace volgi::screen
