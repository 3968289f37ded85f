#pragma once
#include <string>
#include <vector>

#include "core/camera.h"
#include "core/gl/program.h"
#include "screen/base/gbuffer.h"

namespace volgi::screen {

/// The pixels that subsplats consist of, and how they reflect: as matt as their albedo, or as their materials do.
class SubsplatReceivers {
 public:
  SubsplatReceivers(const GBuffer& gbuffer) : gbuffer_(gbuffer) {}  // matt
  /// @param camera  towards which light goes. Matt where nothing in `gbuffer` shines.
  SubsplatReceivers(const GBuffer& gbuffer, const Camera& camera) : gbuffer_(gbuffer), shine_(gbuffer.shines()) {
    const bool perspective = camera.kind == Camera::Kind::perspective;
    viewer_ = perspective ? camera.world_from_camera[3] : camera.world_from_camera[2];
  }
  bool shine() const { return shine_; }
  /// Textures and uniforms of a program with shaders/screen/gather/subsplats/subsplat_light.glsl, which has "SHINES"
  /// among its defines where these shine.
  void bind(const gl::Program& program) const {
    gbuffer_.bind();
    if (!shine_) return;
    gbuffer_.bind_shine();
    program.set("viewer", viewer_);
  }

 private:
  const GBuffer& gbuffer_;
  bool shine_ = false;
  glm::vec4 viewer_{0.0f};
};

}  // namespace volgi::screen
