#include "screen/display/present.h"

#include <cassert>
#include <cmath>

#include "core/gl/raster_state.h"
#include "shaders/screen/display/slots.shared.h"

namespace volgi::screen {

Present::Present() : program_(gl::Program::raster("shared/fullscreen.vert.glsl", "screen/display/present.frag.glsl")) {}

void Present::run(const gl::Texture& radiance, float exposure_ev, const gl::Framebuffer& target, gl::PassTimer& timer) {
  assert(glm::ivec2(radiance.size()) == target.size());
  const auto scope = timer.scope(name);
  gl::begin_fullscreen_pass();
  target.bind();
  radiance.bind(PRESENTED_RADIANCE_UNIT);
  program_.set("exposure", std::exp2(exposure_ev));
  program_.use();
  gl::draw_fullscreen_triangle();
}

}  // namespace volgi::screen
