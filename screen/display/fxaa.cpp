#include "screen/display/fxaa.h"

#include <cassert>

#include "core/gl/raster_state.h"
#include "shaders/screen/display/slots.shared.h"

namespace volgi::screen {

Fxaa::Fxaa() : program_(gl::Program::raster("shared/fullscreen.vert.glsl", "screen/display/fxaa.frag.glsl")) {}

void Fxaa::run(const gl::Texture& picture, const gl::Framebuffer& target, gl::PassTimer& timer) {
  assert(glm::ivec2(picture.size()) == target.size());
  const auto scope = timer.scope(name);
  gl::begin_fullscreen_pass();
  target.bind();
  picture.bind(FXAA_PICTURE_UNIT);
  program_.use();
  gl::draw_fullscreen_triangle();
}

}  // namespace volgi::screen
