#include "screen/base/direct.h"

#include <array>
#include <string>
#include <vector>

#include "core/gl/raster_state.h"

namespace volgi::screen {

namespace {

std::vector<std::string> defines(bool shines, bool glass, bool phong) {
  std::vector<std::string> list;
  if (shines) list.emplace_back("SHINES");
  if (glass) list.emplace_back("GLASS");
  if (phong) list.emplace_back("PHONG");
  return list;
}

}  // namespace

Direct::Direct(glm::ivec2 size, bool shines, bool glass, bool phong)
    : radiance_(gl::Texture::make_2d(GL_RGBA32F, size.x, size.y)),
      program_(gl::Program::raster("shared/fullscreen.vert.glsl", "screen/base/direct.frag.glsl",
                                   defines(shines, glass, phong))) {
  const std::array colors{gl::Framebuffer::Attachment{&radiance_}};
  framebuffer_ = gl::Framebuffer(colors, {}, size);
}

void Direct::run(const GBuffer& gbuffer, const Camera& camera, const ReflectiveShadowMap& maps, gl::PassTimer& timer) {
  const auto scope = timer.scope(name);
  gl::begin_fullscreen_pass(/*add=*/true);
  framebuffer_.bind();
  constexpr std::array zero{0.0f, 0.0f, 0.0f, 0.0f};
  glClearNamedFramebufferfv(framebuffer_.id(), GL_COLOR, 0, zero.data());
  gbuffer.bind();
  if (gbuffer.shines()) gbuffer.bind_shine();
  const bool perspective = camera.kind == Camera::Kind::perspective;
  program_.set("viewer", perspective ? camera.world_from_camera[3] : camera.world_from_camera[2]);
  program_.use();
  for (int light = 0; light < maps.light_count(); ++light) {
    maps.bind(light);
    program_.set("light", light);
    gl::draw_fullscreen_triangle();
  }
}

}  // namespace volgi::screen
