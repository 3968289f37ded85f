#pragma once
#include "core/gl/objects.h"
#include "core/gl/pass_timer.h"
#include "core/gl/program.h"

namespace volgi::screen {

/// Pass "screen/views/wipe": a picture left of a column and its reference right of it, as Present shows them; the
/// column itself is white. Cost: one fullscreen pass.
class Wipe {
 public:
  static constexpr const char* name = "screen/views/wipe";
  Wipe();
  /// @param picture, reference  RGBA32F radiance. @param column  of pixels; below 0 the reference is all there is, from
  /// the width on the picture. @param target  RGBA8 of their size, overwritten.
  void run(const gl::Texture& picture, const gl::Texture& reference, float exposure_ev, int column,
           const gl::Framebuffer& target, gl::PassTimer& timer);

 private:
  gl::Program program_;
};

}  // namespace volgi::screen
