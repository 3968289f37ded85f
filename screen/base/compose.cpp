#include "screen/base/compose.h"

#include <array>
#include <cassert>

#include "core/gl/raster_state.h"

namespace volgi::screen {

Compose::Compose(glm::ivec2 size)
    : radiance_(gl::Texture::make_2d(GL_RGBA32F, size.x, size.y)),
      program_(gl::Program::raster("shared/fullscreen.vert.glsl", "screen/base/compose.frag.glsl")) {
  const std::array colors{gl::Framebuffer::Attachment{&radiance_}};
  framebuffer_ = gl::Framebuffer(colors, {}, size);
}

void Compose::run(const GBuffer& gbuffer, const RadianceLayers& layers, LightPart part, gl::PassTimer& timer) {
  const auto scope = timer.scope(name);
  std::vector<const gl::Texture*> shown;
  if (part != LightPart::indirect) shown.insert(shown.end(), layers.direct.begin(), layers.direct.end());
  if (part != LightPart::direct) shown.insert(shown.end(), layers.indirect.begin(), layers.indirect.end());
  assert(shown.size() <= 8);

  gl::begin_fullscreen_pass();
  framebuffer_.bind();
  gbuffer.position().bind(0);
  for (size_t i = 0; i < shown.size(); ++i) shown[i]->bind(GLuint(1 + i));
  program_.use();
  program_.set("layer_count", int(shown.size()));
  gl::draw_fullscreen_triangle();
}

}  // namespace volgi::screen
