#include "screen/bounces/volume/volume_gather.h"

#include <tbb/parallel_for.h>

#include <array>
#include <glm/gtc/constants.hpp>

#include "core/gl/raster_state.h"
#include "core/octahedral.h"
#include "propagation/pixel_irradiance_cpu.h"
#include "shaders/propagation/slots.shared.h"
#include "shaders/screen/base/slots.shared.h"
#include "shaders/screen/bounces/volume/slots.shared.h"

namespace volgi::screen {

VolumeGather::VolumeGather(glm::ivec2 size)
    : direct_(gl::Texture::make_2d(GL_RGBA32F, size.x, size.y)),
      indirect_(gl::Texture::make_2d(GL_RGBA32F, size.x, size.y)),
      program_(gl::Program::raster("shared/fullscreen.vert.glsl", "screen/bounces/volume/volume_gather.frag.glsl")) {
  std::array<gl::Framebuffer::Attachment, 2> colors{{{&direct_}, {&indirect_}}};
  framebuffer_ = gl::Framebuffer(colors, {}, size);
}

void VolumeGather::run(const GBuffer& gbuffer, const Camera& camera, const Volume& volume, const SmoothGather* with,
                       gl::PassTimer& timer) {
  volume_ = &volume;
  look_from(camera);
  if (with == nullptr) {
    draw(gbuffer, timer);
  } else {
    const std::array<SmoothLight*, 2> lights{&with->first, this};
    with->pixels.run(gbuffer, lights, timer);
  }
  volume_ = nullptr;
}

void VolumeGather::look_from(const Camera& camera) {
  const bool perspective = camera.kind == Camera::Kind::perspective;
  viewer_ = perspective ? camera.world_from_camera[3] : camera.world_from_camera[2];
}

void VolumeGather::run_on_cpu(const GBuffer& gbuffer, const Camera& camera, const VolumeSides& sides,
                              std::span<const SideIrradiance> irradiance, const SmoothGather* with,
                              gl::PassTimer& timer) {
  if (with != nullptr) {
    const std::array<SmoothLight*, 1> first{&with->first};
    with->pixels.run(gbuffer, first, timer);
  }
  const auto scope = timer.scope(name);
  look_from(camera);
  const std::vector<float> positions = gbuffer.position().download(4), normals = gbuffer.normals().download(4),
                           albedos = gbuffer.albedo().download(4);
  const size_t pixels = positions.size() / 4;
  std::vector<glm::vec4> direct(pixels, glm::vec4(0.0f)), indirect = direct;
  tbb::parallel_for(size_t(0), pixels, [&](size_t i) {
    if (positions[4 * i + 3] == 0.0f) return;
    const glm::vec3 position(positions[4 * i], positions[4 * i + 1], positions[4 * i + 2]);
    const glm::vec3 normal = octahedral_decode(glm::vec2(normals[4 * i + 2], normals[4 * i + 3]));  // geometric
    const PixelIrradiance e = irradiance_at_pixel(sides, irradiance, position, normal, viewer_);
    if (e.weight == 0.0f) return;
    const glm::vec3 reflectance =
        glm::vec3(albedos[4 * i], albedos[4 * i + 1], albedos[4 * i + 2]) * glm::one_over_pi<float>();
    direct[i] = glm::vec4(reflectance * e.direct, 1.0f);
    indirect[i] = glm::vec4(reflectance * e.indirect, 1.0f);
  });
  const glm::ivec2 size = direct_.size();
  glTextureSubImage2D(direct_.id(), 0, 0, 0, size.x, size.y, GL_RGBA, GL_FLOAT, direct.data());
  glTextureSubImage2D(indirect_.id(), 0, 0, 0, size.x, size.y, GL_RGBA, GL_FLOAT, indirect.data());
}

void VolumeGather::bind_volume(const gl::Program& program) const {
  volume_->voxels.bind();
  volume_->direct_irradiance.bind_storage(DIRECT_IRRADIANCE_SLOT);
  volume_->indirect_irradiance.bind_storage(INDIRECT_IRRADIANCE_SLOT);
  program.set("viewer", viewer_);
}

void VolumeGather::draw(const GBuffer& gbuffer, gl::PassTimer& timer) {
  const auto scope = timer.scope(name);
  gl::begin_fullscreen_pass();
  framebuffer_.bind();
  gbuffer.bind();
  bind_volume(program_);
  program_.use();
  gl::draw_fullscreen_triangle();
}

void VolumeGather::gather(const WorkList& list, int /*step_px*/, std::span<const gl::Texture> irradiance,
                          gl::PassTimer& timer) {
  const auto scope = timer.scope(name);
  const bool apart = volume_->direct_is_apart;
  std::optional<gl::Program>& program = listed_[apart ? 1 : 0];
  if (!program) {
    program = gl::Program::compute("screen/bounces/volume/volume_gather_listed.comp.glsl",
                                   apart ? std::vector<std::string>{"WITH_DIRECT"} : std::vector<std::string>{});
  }
  bind_volume(*program);
  list.bind(PIXEL_LIST_SLOT);
  irradiance[0].bind_image(GATHERED_INDIRECT_IMAGE, GL_WRITE_ONLY);
  if (apart) irradiance[1].bind_image(GATHERED_DIRECT_IMAGE, GL_WRITE_ONLY);
  program->use();
  list.dispatch();
}

std::vector<const gl::Texture*> VolumeGather::radiance() const {
  std::vector<const gl::Texture*> pictures{&indirect_};
  if (volume_->direct_is_apart) pictures.push_back(&direct_);
  return pictures;
}

}  // namespace volgi::screen
