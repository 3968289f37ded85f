#include "screen/bounces/volume/volume_gather.h"

#include <array>

#include "core/gl/raster_state.h"
#include "shaders/propagation/partial_sums.shared.h"
#include "shaders/propagation/slots.shared.h"

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

void VolumeGather::run(const GBuffer& gbuffer, const Camera& camera, const VoxelGridGl& voxels,
                       const gl::Buffer& direct_irradiance, const gl::Buffer& indirect_irradiance, bool seeps,
                       gl::PassTimer& timer) {
  auto scope = timer.scope(name);
  voxels.bind();
  if (seeps) sum(direct_irradiance);
  gl::begin_fullscreen_pass();
  framebuffer_.bind();
  gbuffer.bind();
  sum_.bind_storage(DIRECT_SUM_SLOT);
  direct_irradiance.bind_storage(DIRECT_IRRADIANCE_SLOT);
  indirect_irradiance.bind_storage(INDIRECT_IRRADIANCE_SLOT);
  program_.use();
  program_.set("seeps", seeps ? 0.01f : 0.0f);
  const bool perspective = camera.kind == Camera::Kind::perspective;
  program_.set("viewer", perspective ? camera.world_from_camera[3] : camera.world_from_camera[2]);
  gl::draw_fullscreen_triangle();
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
