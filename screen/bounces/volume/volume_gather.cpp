#include "screen/bounces/volume/volume_gather.h"

#include <array>

#include "core/gl/raster_state.h"
#include "shaders/propagation/partial_sums.shared.h"
#include "shaders/propagation/slots.shared.h"
#include "shaders/screen/base/slots.shared.h"
#include "shaders/screen/bounces/volume/slots.shared.h"

namespace volgi::screen {

VolumeGather::VolumeGather(glm::ivec2 size)
    : direct_(gl::Texture::make_2d(GL_RGBA32F, size.x, size.y)),
      indirect_(gl::Texture::make_2d(GL_RGBA32F, size.x, size.y)),
      sum_(sizeof(glm::vec4)),
      partials_(PARTIAL_SUMS * sizeof(glm::vec4)),
      program_(gl::Program::raster("shared/fullscreen.vert.glsl", "screen/bounces/volume/volume_gather.frag.glsl")),
      sum_sides_(gl::Program::compute("propagation/sum_sent.comp.glsl")),
      sum_partials_(gl::Program::compute("propagation/sum_partials.comp.glsl")) {
  std::array<gl::Framebuffer::Attachment, 2> colors{{{&direct_}, {&indirect_}}};
  framebuffer_ = gl::Framebuffer(colors, {}, size);
}

void VolumeGather::run(const GBuffer& gbuffer, const Camera& camera, const Volume& volume, const SmoothGather* with,
                       gl::PassTimer& timer) {
  volume_ = &volume;
  const bool perspective = camera.kind == Camera::Kind::perspective;
  viewer_ = perspective ? camera.world_from_camera[3] : camera.world_from_camera[2];
  if (volume.seeps) {
    const auto scope = timer.scope(name);
    sum(volume.direct_irradiance);
  }
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
  sum_.bind_storage(DIRECT_SUM_SLOT);
  volume_->direct_irradiance.bind_storage(DIRECT_IRRADIANCE_SLOT);
  volume_->indirect_irradiance.bind_storage(INDIRECT_IRRADIANCE_SLOT);
  program.set("seeps", volume_->seeps ? 0.01f : 0.0f);
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

void VolumeGather::gather(const WorkList& list, std::span<const gl::Texture> irradiance, gl::PassTimer& timer) {
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

void VolumeGather::sum(const gl::Buffer& irradiance) const {
  irradiance.bind_storage(SENT_SLOT);
  partials_.bind_storage(PARTIALS_SLOT);
  sum_sides_.use();
  gl::dispatch({PARTIAL_SUMS, 1, 1}, {1, 1, 1});
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  sum_.bind_storage(SUM_SLOT);
  sum_partials_.use();
  gl::dispatch({1, 1, 1}, {1, 1, 1});
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

}  // namespace volgi::screen
