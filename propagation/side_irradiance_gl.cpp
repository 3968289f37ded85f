#include "propagation/side_irradiance_gl.h"

#include "shaders/propagation/slots.shared.h"
#include "shaders/shared/group_sizes.shared.h"

namespace volgi {

SideIrradianceGl::SideIrradianceGl()
    : side_irradiance_(gl::Program::compute("propagation/side_irradiance.comp.glsl")),
      smooth_(gl::Program::compute("propagation/smooth_sides.comp.glsl")) {}

void SideIrradianceGl::run(const VoxelGridGl& voxels, const SideFluxGl& flux, const gl::Buffer& direct,
                           const gl::Buffer& indirect, gl::PassTimer& timer) {
  auto scope = timer.scope("propagation/side_irradiance");
  if (capacity_ != voxels.side_capacity) {
    capacity_ = voxels.side_capacity;
    for (gl::Buffer* b : {&raw_direct_, &raw_indirect_, &direct_, &indirect_}) {
      *b = gl::Buffer(sizeof(glm::vec4) * size_t(capacity_));
    }
  }
  voxels.bind();
  direct.bind_storage(TOTAL_DIRECT_SLOT);
  indirect.bind_storage(TOTAL_INDIRECT_SLOT);
  flux.emitted().bind_storage(EMITTED_FLUX_SLOT);
  flux.punctual().bind_storage(PUNCTUAL_FLUX_SLOT);
  raw_direct_.bind_storage(WEIGHTED_DIRECT_SLOT);
  raw_indirect_.bind_storage(WEIGHTED_INDIRECT_SLOT);
  side_irradiance_.use();
  gl::dispatch_linear(capacity_, LINEAR_GROUP);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  direct_.bind_storage(DIRECT_IRRADIANCE_SLOT);
  indirect_.bind_storage(INDIRECT_IRRADIANCE_SLOT);
  smooth_.use();
  gl::dispatch_linear(capacity_, LINEAR_GROUP);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

size_t SideIrradianceGl::bytes_for(std::uint32_t side_capacity) {
  return 4 * sizeof(glm::vec4) * size_t(side_capacity);
}

size_t SideIrradianceGl::bytes() const {
  return raw_direct_.bytes() + raw_indirect_.bytes() + direct_.bytes() + indirect_.bytes();
}

}  // namespace volgi
