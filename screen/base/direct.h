#pragma once
#include "core/gl/objects.h"
#include "core/gl/pass_timer.h"
#include "core/gl/program.h"
#include "screen/base/gbuffer.h"
#include "screen/base/reflective_shadow_map.h"

namespace volgi::screen {

/// Pass "screen/base/direct": light of the punctual lights after one reflection at the visible surface, with shadows.
/// No cosine below either the shading normal's or the geometric normal's horizon. Cost: one fullscreen pass per light.
class Direct {
 public:
  static constexpr const char* name = "screen/base/direct";
  /// @param shines  as the G-buffer that it reads. @param glass  the scene has some.
  /// @param phong  has_phong_lobes().
  explicit Direct(glm::ivec2 size, bool shines = false, bool glass = false, bool phong = false);
  void run(const GBuffer& gbuffer, const Camera& camera, const ReflectiveShadowMap& maps, gl::PassTimer& timer);

  const gl::Texture& radiance() const { return radiance_; }  // RGBA32F [W m^-2 sr^-1]
  size_t bytes() const { return 16 * size_t(radiance_.size().x) * size_t(radiance_.size().y); }

 private:
  gl::Texture radiance_;
  gl::Framebuffer framebuffer_;
  gl::Program program_;
};

}  // namespace volgi::screen
