#pragma once
#include "core/gl/objects.h"
#include "core/gl/pass_timer.h"
#include "core/gl/program.h"

namespace volgi::screen {

/// Pass "screen/display/present": radiance times 2^exposure as a display shows it, tone_map() and srgb_encode() of
/// core/image.h: what write_png() writes. Cost: one fullscreen pass.
class Present {
 public:
  static constexpr const char* name = "screen/display/present";
  Present();
  /// @param radiance  RGBA32F [W m^-2 sr^-1]. @param target  of its size, RGBA8.
  void run(const gl::Texture& radiance, float exposure_ev, const gl::Framebuffer& target, gl::PassTimer& timer);

 private:
  gl::Program program_;
};

}  // namespace volgi::screen
