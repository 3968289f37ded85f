#include "screen/bounces/volume/volume_gather.h"

#include <array>

#include "core/gl/raster_state.h"
#include "shaders/propagation/slots.shared.h"

namespace volgi::screen {

VolumeGather::VolumeGather(glm::ivec2 size)
    : direct_(gl::Texture::make_2d(GL_RGBA32F, size.x, size.y)),
      indirect_(gl::Texture::make_2d(GL_RGBA32F, size.x, size.y)),
      program_(gl::Program::raster("shared/fullscreen.vert.glsl", "screen/bounces/volume/volume_gather.frag.glsl")) {
  std::array<gl::Framebuffer::Attachment, 2> colors{{{&direct_}, {&indirect_}}};
  framebuffer_ = gl::Framebuffer(colors, {}, size);
}

void VolumeGather::run(const GBuffer& gbuffer, const Camera& camera, const VoxelGridGl& voxels,
                       const gl::Buffer& direct_irradiance, const gl::Buffer& indirect_irradiance,
                       gl::PassTimer& timer) {
  auto scope = timer.scope(name);
  gl::begin_fullscreen_pass();
  framebuffer_.bind();
  gbuffer.bind();
  voxels.bind();
  direct_irradiance.bind_storage(DIRECT_IRRADIANCE_SLOT);
  indirect_irradiance.bind_storage(INDIRECT_IRRADIANCE_SLOT);
  program_.use();
  const bool perspective = camera.kind == Camera::Kind::perspective;
  program_.set("viewer", perspective ? camera.world_from_camera[3] : camera.world_from_camera[2]);
  gl::draw_fullscreen_triangle();
}

}  // namespace volgi::screen
