#include "screen/base/gbuffer.h"

#include <array>

#include "core/gl/limits.h"
#include "core/gl/raster_state.h"
#include "shaders/screen/base/gbuffer.shared.h"

namespace volgi::screen {

GBuffer::GBuffer(glm::ivec2 size, GLenum normal_format)
    : size_(size),
      depth_(gl::Texture::make_2d(GL_DEPTH_COMPONENT32F, size.x, size.y)),
      position_(gl::Texture::make_2d(GL_RGBA32F, size.x, size.y)),
      normals_(gl::Texture::make_2d(gl::renderable_format(normal_format, GL_RGBA32F), size.x, size.y)),
      albedo_(gl::Texture::make_2d(GL_RGBA16, size.x, size.y)),
      emission_(gl::Texture::make_2d(GL_RGBA32F, size.x, size.y)),
      object_id_(gl::Texture::make_2d(GL_R32UI, size.x, size.y)),
      program_(gl::Program::raster(name)) {
  using Attachment = gl::Framebuffer::Attachment;
  const std::array colors{Attachment{&position_}, Attachment{&normals_}, Attachment{&albedo_}, Attachment{&emission_},
                          Attachment{&object_id_}};
  framebuffer_ = gl::Framebuffer(colors, {&depth_}, size);
}

void GBuffer::run(const gl::SceneBuffers& scene, const Camera& camera, gl::PassTimer& timer) {
  const auto scope = timer.scope(name);
  gl::begin_geometry_pass();
  framebuffer_.bind();
  constexpr std::array zero{0.0f, 0.0f, 0.0f, 0.0f};
  constexpr std::array<GLuint, 4> no_object{};
  for (GLint i = 0; i < 4; ++i) glClearNamedFramebufferfv(framebuffer_.id(), GL_COLOR, i, zero.data());
  glClearNamedFramebufferuiv(framebuffer_.id(), GL_COLOR, 4, no_object.data());
  glClearNamedFramebufferfv(framebuffer_.id(), GL_DEPTH, 0, zero.data());

  program_.set("clip_from_world", clip_from_camera(camera, size_) * camera_from_world(camera));
  const bool perspective = camera.kind == Camera::Kind::perspective;
  program_.set("viewer", perspective ? camera.world_from_camera[3] : camera.world_from_camera[2]);
  scene.draw(program_);
}

void GBuffer::bind() const {
  position_.bind(GBUFFER_POSITION_UNIT);
  normals_.bind(GBUFFER_NORMALS_UNIT);
  albedo_.bind(GBUFFER_ALBEDO_UNIT);
}

}  // namespace volgi::screen
