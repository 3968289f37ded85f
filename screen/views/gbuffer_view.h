#pragma once
#include "core/camera.h"
#include "core/gl/objects.h"
#include "core/gl/pass_timer.h"
#include "core/gl/program.h"
#include "screen/base/gbuffer.h"
#include "shaders/screen/views/view_modes.shared.h"

namespace volgi::screen {

/// Pass "screen/views/gbuffer_view": what the camera sees, before any light, in place of the picture. Cost: one
/// fullscreen pass.
class GBufferView {
 public:
  static constexpr const char* name = "screen/views/gbuffer_view";
  enum class Mode {
    albedo = VIEW_ALBEDO,                      // sRGB encoded
    shading_normal = VIEW_SHADING_NORMAL,      // 0.5 + 0.5 n, world axes
    geometric_normal = VIEW_GEOMETRIC_NORMAL,  // likewise
    depth = VIEW_DEPTH,                        // viridis over depth_range_m, with 16 contours
    emission = VIEW_EMISSION,                  // as Present shows radiance; the sky as well
    object_id = VIEW_OBJECT_ID,                // a colour of its own for each
  };
  struct Options {
    Mode mode = Mode::albedo;
    glm::vec2 depth_range_m{0.0f, 10.0f};  // along the camera's axis, from its position
    float exposure_ev = 0.0f;              // of emission
  };
  GBufferView();
  /// @param camera  of the G-buffer. @param target  RGBA8 of its size, overwritten.
  void run(const GBuffer& gbuffer, const Camera& camera, const Options& options, const gl::Framebuffer& target,
           gl::PassTimer& timer);

 private:
  gl::Program program_;
};

}  // namespace volgi::screen
