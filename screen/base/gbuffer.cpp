#include "screen/base/gbuffer.h"

#include <array>
#include <glm/gtc/matrix_transform.hpp>
#include <string>
#include <vector>

#include "core/gl/limits.h"
#include "core/gl/raster_state.h"
#include "screen/base/directional_albedo.h"
#include "shaders/screen/base/gbuffer.shared.h"
#include "shaders/shared/material.shared.h"

namespace volgi::screen {
namespace {

std::vector<std::string> defines(bool shines, bool phong) {
  std::vector<std::string> list;
  if (shines) list.emplace_back("SHINES");
  if (phong) list.emplace_back("PHONG");
  return list;
}

}  // namespace

GBuffer::GBuffer(glm::ivec2 size, GLenum normal_format, bool shines, bool phong)
    : size_(size),
      shines_(shines),
      phong_(phong),
      depth_(gl::Texture::make_2d(GL_DEPTH_COMPONENT32F, size.x, size.y)),
      position_(gl::Texture::make_2d(GL_RGBA32F, size.x, size.y)),
      normals_(gl::Texture::make_2d(gl::renderable_format(normal_format, GL_RGBA32F), size.x, size.y)),
      albedo_(gl::Texture::make_2d(GL_RGBA16, size.x, size.y)),
      emission_(gl::Texture::make_2d(GL_RGBA32F, size.x, size.y)),
      object_id_(gl::Texture::make_2d(GL_R32UI, size.x, size.y)),
      program_(gl::Program::raster(name, defines(shines, phong))) {
  using Attachment = gl::Framebuffer::Attachment;
  std::vector<Attachment> colors{{&position_}, {&normals_}, {&albedo_}, {&emission_}, {&object_id_}};
  if (shines) {
    diffuse_ = gl::Texture::make_2d(GL_RGBA16, size.x, size.y);
    mirror_ = gl::Texture::make_2d(GL_RGBA16, size.x, size.y);
    colors.push_back({&diffuse_});
    colors.push_back({&mirror_});
    constexpr int n = DIRECTIONAL_ALBEDO_SIZE;
    directional_albedo_ = gl::Texture::make_2d(GL_RG32F, n, n);
    glTextureSubImage2D(directional_albedo_.id(), 0, 0, 0, n, n, GL_RG, GL_FLOAT, directional_albedo(phong).data());
    directional_albedo_.filter(GL_LINEAR, GL_LINEAR);
  }
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

  if (shines_) {
    for (GLint i : {5, 6}) glClearNamedFramebufferfv(framebuffer_.id(), GL_COLOR, i, zero.data());
    directional_albedo_.bind(DIRECTIONAL_ALBEDO_UNIT);
    program_.set("least_mirror_apart", mirror_apart_.value_or(2.0f));  // more than there is
  }
  // What lies `jitter` beside the centre moves onto it.
  const glm::vec3 moved(-2.0f * jitter_ / glm::vec2(size_), 0.0f);
  clip_from_world_ =
      glm::translate(glm::mat4(1.0f), moved) * clip_from_camera(camera, size_) * camera_from_world(camera);
  program_.set("clip_from_world", clip_from_world_);
  const bool perspective = camera.kind == Camera::Kind::perspective;
  program_.set("viewer", perspective ? camera.world_from_camera[3] : camera.world_from_camera[2]);
  scene.draw(program_);
}

void GBuffer::bind() const {
  position_.bind(GBUFFER_POSITION_UNIT);
  normals_.bind(GBUFFER_NORMALS_UNIT);
  albedo_.bind(GBUFFER_ALBEDO_UNIT);
}

void GBuffer::bind_shine() const {
  diffuse_.bind(GBUFFER_DIFFUSE_UNIT);
  mirror_.bind(GBUFFER_MIRROR_UNIT);
}

void GBuffer::list_textures(std::vector<NamedTexture>& list) const {
  list_texture(list, name, "depth", depth_);
  list_texture(list, name, "position", position_);
  list_texture(list, name, "normals", normals_);
  list_texture(list, name, "albedo", albedo_);
  list_texture(list, name, "diffuse reflectance", diffuse_);
  list_texture(list, name, "mirror reflectance", mirror_);
  list_texture(list, name, "emission", emission_);
  list_texture(list, name, "object id", object_id_);
}

}  // namespace volgi::screen
