#pragma once
#include "core/gl/objects.h"
#include "core/gl/pass_timer.h"
#include "core/gl/program.h"

namespace volgi::screen {

/// Pass "screen/views/error_view": picture less reference, mean of the bands, in place of the picture: white where they
/// are equal, red where the picture is too bright, blue where too dark; NaN is magenta, infinity cyan. Cost: one
/// fullscreen pass.
class ErrorView {
 public:
  static constexpr const char* name = "screen/views/error_view";
  struct Options {
    /// Over the reference plus floor_radiance: with error_floor() what `compare --diff` shows; else [W m^-2 sr^-1].
    bool relative = true;
    float range = 0.5f;           // of full red and full blue
    float floor_radiance = 0.0f;  // [W m^-2 sr^-1]
  };
  ErrorView();
  /// @param picture, reference  RGBA32F radiance. @param target  RGBA8 of their size, overwritten.
  void run(const gl::Texture& picture, const gl::Texture& reference, const Options& options,
           const gl::Framebuffer& target, gl::PassTimer& timer);

 private:
  gl::Program program_;
};

/// A tenth of the mean of a reference's bands: dark pixels then do not count more than they are seen. Waits for the
/// GPU: between frames, once for a reference.
float error_floor(const gl::Texture& reference);

}  // namespace volgi::screen
