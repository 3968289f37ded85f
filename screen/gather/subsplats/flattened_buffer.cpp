#include "screen/gather/subsplats/flattened_buffer.h"

#include <algorithm>
#include <array>

#include "core/gl/raster_state.h"

namespace volgi::screen {

FlattenedBuffer::FlattenedBuffer(const SubsplatLevels& levels)
    : levels_(levels),
      irradiance_(gl::Texture::make_2d(GL_RGBA32F, levels.flattened().x, levels.flattened().y)),
      stencil_(gl::Texture::make_2d(GL_DEPTH24_STENCIL8, levels.flattened().x, levels.flattened().y)),
      mark_(gl::Program::raster("shared/fullscreen.vert.glsl", "screen/gather/subsplats/mark_fragments.frag.glsl")) {
  const std::array colors{gl::Framebuffer::Attachment{&irradiance_}};
  framebuffer_ = gl::Framebuffer(colors, {&stencil_}, levels.flattened());
}

void FlattenedBuffer::clear() const {
  gl::begin_fullscreen_pass();
  constexpr std::array nothing{0.0f, 0.0f, 0.0f, 0.0f};
  glClearNamedFramebufferfv(framebuffer_.id(), GL_COLOR, 0, nothing.data());
}

void FlattenedBuffer::mark(const GBuffer& gbuffer, const DiscontinuityMipmaps& mipmaps, gl::PassTimer& timer) const {
  const auto scope = timer.scope(mark_name);
  gl::begin_fullscreen_pass();
  framebuffer_.bind();
  glStencilMask(0xff);
  glClearNamedFramebufferfi(framebuffer_.id(), GL_DEPTH_STENCIL, 0, 0.0f, 0);
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  glEnable(GL_STENCIL_TEST);
  glStencilFunc(GL_ALWAYS, 1, 0xff);
  glStencilOp(GL_KEEP, GL_KEEP, GL_REPLACE);
  gbuffer.bind();
  mipmaps.bind(mark_);
  mark_.use();
  gl::draw_fullscreen_triangle();
  glDisable(GL_STENCIL_TEST);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

void FlattenedBuffer::begin(Draw draw) const {
  gl::begin_fullscreen_pass(true);
  if (draw == Draw::subtracts) glBlendEquation(GL_FUNC_REVERSE_SUBTRACT);
  framebuffer_.bind();
}

void FlattenedBuffer::draw_marked() const {
  glEnable(GL_STENCIL_TEST);
  glStencilFunc(GL_EQUAL, 1, 0xff);
  glStencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
  gl::draw_fullscreen_triangle();
  glDisable(GL_STENCIL_TEST);
}

size_t FlattenedBuffer::fragments() const {
  const std::vector<float> texels = irradiance_.download(4);
  size_t count = 0;
  for (size_t i = 3; i < texels.size(); i += 4) count += texels[i] > 0.0f ? 1 : 0;
  return count;
}

}  // namespace volgi::screen
