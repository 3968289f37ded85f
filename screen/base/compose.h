#pragma once
#include <optional>
#include <span>

#include "core/gl/objects.h"
#include "core/gl/pass_timer.h"
#include "core/gl/program.h"
#include "screen/base/gbuffer.h"
#include "screen/base/glass.h"
#include "shaders/screen/base/compose.shared.h"

namespace volgi::screen {

/// Pass "screen/base/compose": the sum of radiance layers, in their order, seen through the glass in front of it.
class Compose {
 public:
  static constexpr const char* name = "screen/base/compose";
  explicit Compose(glm::ivec2 size);
  static constexpr size_t MAX_LAYERS = COMPOSE_LAYERS;
  /// @param layers  RGBA32F of the G-buffer's size; each light path in one of them only, which the caller sees to.
  /// @throws Error(over_limit) above MAX_LAYERS.
  /// @param scene  with glass: that of the G-buffer; null: nothing is in front.
  /// @param background  the one of `layers` that is shown where there is no geometry; null, or none of them: black.
  void run(const GBuffer& gbuffer, std::span<const gl::Texture* const> layers, const gl::Texture* background,
           gl::PassTimer& timer, const gl::SceneBuffers* scene = nullptr);

  const gl::Texture& radiance() const { return radiance_; }  // RGBA32F [W m^-2 sr^-1]
  size_t bytes() const { return 16 * size_t(radiance_.size().x) * size_t(radiance_.size().y); }

 private:
  gl::Texture radiance_;
  gl::Framebuffer framebuffer_;
  gl::Program program_;
  std::optional<Glass> glass_;     // where there is some
  gl::Framebuffer through_glass_;  // the sum, behind the G-buffer's depth
};

}  // namespace volgi::screen
