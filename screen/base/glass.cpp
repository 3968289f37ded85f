#include "screen/base/glass.h"

#include "core/gl/raster_state.h"

namespace volgi::screen {

Glass::Glass()
    : program_(gl::Program::raster("screen/base/reflective_shadow_map.vert.glsl", "screen/base/glass.frag.glsl")) {}

void Glass::run(const gl::SceneBuffers& scene, const gl::Framebuffer& target, const glm::mat4& clip_from_world) const {
  gl::begin_filter_pass();
  target.bind();
  program_.set("clip_from_world", clip_from_world);
  scene.draw_glass(program_);
}

}  // namespace volgi::screen
