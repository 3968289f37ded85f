#include "screen/views/view_target.h"

#include <array>
#include <cassert>

#include "core/gl/raster_state.h"
#include "screen/views/view_camera_internal.h"

namespace volgi::screen {

ViewTarget::ViewTarget(glm::ivec2 size)
    : picture_(gl::Texture::make_2d(GL_RGBA8, size.x, size.y)),
      depth_(gl::Texture::make_2d(GL_DEPTH_COMPONENT32F, size.x, size.y)),
      dim_(gl::Program::raster("shared/fullscreen.vert.glsl", "screen/views/view_target.frag.glsl")),
      push_back_(gl::Program::raster("shared/fullscreen.vert.glsl", "screen/views/view_target.frag.glsl", {"DEPTH"})) {
  const std::array colors{gl::Framebuffer::Attachment{&picture_}};
  framebuffer_ = gl::Framebuffer(colors, {&depth_}, size);
  picture_.clear({0.0f, 0.0f, 0.0f, 1.0f});
}

void ViewTarget::begin_overlays(const Overlays& overlays, const Camera& camera, gl::PassTimer& timer) {
  const auto scope = timer.scope(name);
  framebuffer_.bind();
  if (overlays.brightness < 1.0f) {
    gl::begin_fullscreen_pass(true);
    glBlendFunc(GL_ZERO, GL_SRC_COLOR);
    dim_.set("brightness", overlays.brightness);
    dim_.use();
    gl::draw_fullscreen_triangle();
  }
  take_depth(overlays, camera);
}

void ViewTarget::take_depth(const Overlays& overlays, const Camera& camera) {
  const GBuffer* gbuffer = overlays.gbuffer;
  assert(gbuffer == nullptr || gbuffer->size() == framebuffer_.size());
  if (gbuffer != nullptr && overlays.slack_m <= 0.0f) {
    glCopyImageSubData(gbuffer->depth().id(), GL_TEXTURE_2D, 0, 0, 0, 0, depth_.id(), GL_TEXTURE_2D, 0, 0, 0, 0,
                       depth_.size().x, depth_.size().y, 1);
    return;
  }
  gl::begin_geometry_pass();  // what may not be written is not cleared either
  constexpr float far_away = 0.0f;
  glClearNamedFramebufferfv(framebuffer_.id(), GL_DEPTH, 0, &far_away);
  if (gbuffer == nullptr) return;
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  gbuffer->bind();
  set_view_camera(push_back_, camera, framebuffer_.size());
  push_back_.set("slack_m", overlays.slack_m);
  push_back_.use();
  gl::draw_fullscreen_triangle();
}

}  // namespace volgi::screen
