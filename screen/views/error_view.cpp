#include "screen/views/error_view.h"

#include <algorithm>
#include <cassert>

#include "core/gl/raster_state.h"
#include "shaders/screen/views/slots.shared.h"

namespace volgi::screen {

ErrorView::ErrorView()
    : program_(gl::Program::raster("shared/fullscreen.vert.glsl", "screen/views/error_view.frag.glsl")) {}

void ErrorView::run(const gl::Texture& picture, const gl::Texture& reference, const Options& options,
                    const gl::Framebuffer& target, gl::PassTimer& timer) {
  assert(picture.size() == reference.size() && glm::ivec2(picture.size()) == target.size());
  const auto scope = timer.scope(name);
  gl::begin_fullscreen_pass();
  target.bind();
  picture.bind(JUDGED_RADIANCE_UNIT);
  reference.bind(REFERENCE_RADIANCE_UNIT);
  program_.set("relative", int(options.relative));
  program_.set("range", std::max(options.range, 1e-30f));
  program_.set("floor_radiance", std::max(options.floor_radiance, 1e-9f));  // black on black is right
  program_.use();
  gl::draw_fullscreen_triangle();
}

float error_floor(const gl::Texture& reference) {
  const std::vector<float> values = reference.download(3);
  double sum = 0.0;
  for (float v : values) sum += double(v);
  return std::max(float(0.1 * sum / double(values.size())), 1e-9f);
}

}  // namespace volgi::screen
