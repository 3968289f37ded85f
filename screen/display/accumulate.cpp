#include "screen/display/accumulate.h"

#include <cassert>

#include "shaders/screen/display/slots.shared.h"
#include "shaders/shared/group_sizes.shared.h"

namespace volgi::screen {

Accumulate::Accumulate(glm::ivec2 size)
    : mean_(gl::Texture::make_2d(GL_RGBA32F, size.x, size.y)),
      program_(gl::Program::compute("screen/display/accumulate.comp.glsl")) {
  mean_.clear({0.0f, 0.0f, 0.0f, 1.0f});
}

void Accumulate::add(const gl::Texture& radiance, gl::PassTimer& timer) {
  assert(radiance.size() == mean_.size());
  const auto scope = timer.scope(name);
  radiance.bind(ACCUMULATED_RADIANCE_UNIT);
  mean_.bind_image(MEAN_RADIANCE_IMAGE, GL_READ_WRITE);
  program_.set("count", ++count_);
  program_.use();
  gl::dispatch({mean_.size().x, mean_.size().y, 1}, {SQUARE_GROUP, SQUARE_GROUP, 1});
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);  // shown, and added to
}

}  // namespace volgi::screen
