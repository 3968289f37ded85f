#include "propagation/side_irradiance_gl.h"

namespace volgi {

SideIrradianceGl::SideIrradianceGl()
    : side_irradiance_(gl::Program::compute("propagation/side_irradiance.comp.glsl")),
      smooth_(gl::Program::compute("propagation/smooth_sides.comp.glsl")) {}

void SideIrradianceGl::run(const VoxelGridGl& voxels, const SideFluxGl& flux, const BouncesGl& bounces,
                           gl::PassTimer& timer) {
  auto scope = timer.scope("propagation/side_irradiance");
  if (capacity_ != voxels.side_capacity) {
    capacity_ = voxels.side_capacity;
    for (gl::Buffer* b : {&raw_direct_, &raw_indirect_, &direct_, &indirect_}) {
      *b = gl::Buffer(sizeof(glm::vec4) * size_t(capacity_));
    }
  }
  voxels.bind();
  bounces.received_direct().bind_storage(6);
  bounces.received_indirect().bind_storage(7);
  flux.emitted().bind_storage(8);
  flux.punctual().bind_storage(9);
  raw_direct_.bind_storage(10);
  raw_indirect_.bind_storage(11);
  side_irradiance_.use();
  gl::dispatch_linear(capacity_, 64);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  direct_.bind_storage(6);
  indirect_.bind_storage(7);
  smooth_.use();
  gl::dispatch_linear(capacity_, 64);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

size_t SideIrradianceGl::bytes_for(std::uint32_t side_capacity) {
  return 4 * sizeof(glm::vec4) * size_t(side_capacity);
}

size_t SideIrradianceGl::bytes() const {
  return raw_direct_.bytes() + raw_indirect_.bytes() + direct_.bytes() + indirect_.bytes();
}

}  // namespace volgi
