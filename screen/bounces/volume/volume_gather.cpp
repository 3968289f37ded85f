#include "screen/bounces/volume/volume_gather.h"

#include <array>

#include "core/gl/raster_state.h"
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
  const bool perspective = camera.kind == Camera::Kind::perspective;
  viewer_ = perspective ? camera.world_from_camera[3] : camera.world_from_camera[2];
  if (with == nullptr) {
    draw(gbuffer, timer);
  } else {
    const std::array<SmoothLight*, 2> lights{&with->first, this};
    with->pixels.run(gbuffer, lights, timer);
  }
  volume_ = nullptr;
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
