#pragma once
#include "core/camera.h"
#include "core/gl/objects.h"
#include "core/gl/pass_timer.h"
#include "core/gl/program.h"
#include "core/sky.h"
#include "screen/base/gbuffer.h"

namespace volgi::screen {

/// Pass "screen/base/sky_seen": the sky where the camera sees no surface, into the G-buffer's emission. Cost: one
/// fullscreen pass.
class SkySeen {
 public:
  static constexpr const char* name = "screen/base/sky_seen";
  /// @param gbuffer  must outlive this.
  explicit SkySeen(const GBuffer& gbuffer);
  void run(const Sky& sky, const Camera& camera, gl::PassTimer& timer);
  /// Latitude-longitude, RGBA32F with all mipmaps [W m^-2 sr^-1]: shaders/screen/base/sky_picture.glsl.
  const gl::Texture& picture() const { return picture_; }
  size_t bytes() const { return 16 * size_t(picture_.size().x) * size_t(picture_.size().y); }

 private:
  const GBuffer& gbuffer_;
  std::uint64_t uploaded_ = 0;  // Sky::id()
  gl::Texture picture_;
  gl::Framebuffer framebuffer_;
  gl::Program program_;
};

}  // namespace volgi::screen
