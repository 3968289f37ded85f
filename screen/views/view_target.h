#pragma once
#include "core/camera.h"
#include "core/gl/objects.h"
#include "core/gl/pass_timer.h"
#include "core/gl/program.h"
#include "screen/base/gbuffer.h"

namespace volgi::screen {

/// Pass "screen/views/view_target": a picture in display values, with a depth of its own that overlays share, so that
/// they hide each other and are hidden by what the picture shows. Present and views that replace the picture draw into
/// framebuffer() first; then begin_overlays(); then views that draw over it, in any order. Cost: 8 bytes a pixel copied
/// or cleared; a fullscreen pass where the picture is dimmed, one where its surfaces are pushed back.
class ViewTarget {
 public:
  static constexpr const char* name = "screen/views/view_target";
  /// Slack in edges of cells for sides of the volume: half of one, and what tilted surfaces are farther away.
  static constexpr float SIDES_SLACK_CELLS = 0.75f;
  explicit ViewTarget(glm::ivec2 size);

  struct Overlays {
    const GBuffer* gbuffer = nullptr;  // whose surfaces hide overlays; null: nothing does
    float slack_m = 0.0f;              // what is so near behind a surface, across it, is not hidden
    float brightness = 1.0f;           // factor on what the picture shows so far, 0 to 1
  };
  /// @param camera  of the G-buffer.
  void begin_overlays(const Overlays& overlays, const Camera& camera, gl::PassTimer& timer);

  const gl::Texture& picture() const { return picture_; }  // RGBA8, sRGB encoded
  const gl::Texture& depth() const { return depth_; }      // D32F, reversed
  const gl::Framebuffer& framebuffer() const { return framebuffer_; }
  size_t bytes() const { return 8 * size_t(picture_.size().x) * size_t(picture_.size().y); }

 private:
  void take_depth(const Overlays& overlays, const Camera& camera);

  gl::Texture picture_, depth_;
  gl::Framebuffer framebuffer_;
  gl::Program dim_, push_back_;
};

}  // namespace volgi::screen
