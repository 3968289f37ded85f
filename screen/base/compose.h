#pragma once
#include <span>
#include <vector>

#include "core/gl/objects.h"
#include "core/gl/pass_timer.h"
#include "core/gl/program.h"
#include "screen/base/gbuffer.h"

namespace volgi::screen {

/// What of the light a picture shows (--light). `direct`: straight from any emitter to the surface, plus emission seen
/// by the camera; `indirect`: after at least one reflection before the visible surface.
enum class LightPart { full, direct, indirect };

/// Radiance layers (RGBA32F, size of the G-buffer). The caller sees to it that each light path is in one layer only.
struct RadianceLayers {
  std::vector<const gl::Texture*> direct;
  std::vector<const gl::Texture*> indirect;
};

/// Pass "screen/base/compose": the sum of the layers that `part` asks for, at most 8; black in the background.
class Compose {
 public:
  static constexpr const char* name = "screen/base/compose";
  explicit Compose(glm::ivec2 size);
  void run(const GBuffer& gbuffer, const RadianceLayers& layers, LightPart part, gl::PassTimer& timer);

  const gl::Texture& radiance() const { return radiance_; }  // RGBA32F [W m^-2 sr^-1]

 private:
  gl::Texture radiance_;
  gl::Framebuffer framebuffer_;
  gl::Program program_;
};

}  // namespace volgi::screen
