#include "screen/views/wipe.h"

#include <cassert>
#include <cmath>

#include "core/gl/raster_state.h"
#include "shaders/screen/views/slots.shared.h"

namespace volgi::screen {

Wipe::Wipe() : program_(gl::Program::raster("shared/fullscreen.vert.glsl", "screen/views/wipe.frag.glsl")) {}

void Wipe::run(const gl::Texture& picture, const gl::Texture& reference, float exposure_ev, int column,
               const gl::Framebuffer& target, gl::PassTimer& timer) {
  assert(picture.size() == reference.size() && glm::ivec2(picture.size()) == target.size());
  const auto scope = timer.scope(name);
  gl::begin_fullscreen_pass();
  target.bind();
  picture.bind(JUDGED_RADIANCE_UNIT);
  reference.bind(REFERENCE_RADIANCE_UNIT);
  program_.set("column", column);
  program_.set("exposure", std::exp2(exposure_ev));
  program_.use();
  gl::draw_fullscreen_triangle();
}

}  // namespace volgi::screen
