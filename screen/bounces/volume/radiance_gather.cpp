#include "screen/bounces/volume/radiance_gather.h"

#include <fmt/format.h>

#include <array>

#include "core/gl/raster_state.h"
#include "shaders/screen/bounces/volume/slots.shared.h"

namespace volgi::screen {

RadianceGather::RadianceGather(glm::ivec2 size, int sh_order)
    : direct_(gl::Texture::make_2d(GL_RGBA32F, size.x, size.y)),
      indirect_(gl::Texture::make_2d(GL_RGBA32F, size.x, size.y)),
      program_(gl::Program::raster("shared/fullscreen.vert.glsl", "screen/bounces/volume/radiance_gather.frag.glsl",
                                   {fmt::format("ORDER {}", sh_order)})) {
  std::array<gl::Framebuffer::Attachment, 2> colors{{{&direct_}, {&indirect_}}};
  framebuffer_ = gl::Framebuffer(colors, {}, size);
}

void RadianceGather::run(const GBuffer& gbuffer, const VoxelGridGl& voxels, const RadianceVolumeGl& radiance,
                         const gl::Texture* normal_occupancy, gl::PassTimer& timer) {
  auto scope = timer.scope(name);
  gl::begin_fullscreen_pass();
  framebuffer_.bind();
  gbuffer.bind();
  radiance.sh.bind(RADIANCE_UNIT);
  if (normal_occupancy != nullptr) normal_occupancy->bind(OCCUPANCY_UNIT);
  voxels.bind();
  program_.use();
  program_.set("occupied_only", int(normal_occupancy != nullptr));
  gl::draw_fullscreen_triangle();
}

}  // namespace volgi::screen
