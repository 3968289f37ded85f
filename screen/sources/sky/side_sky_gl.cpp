#include "screen/sources/sky/side_sky_gl.h"

#include <algorithm>

#include "propagation/light_in/side_sky_cpu.h"
#include "shaders/screen/sources/sky/slots.shared.h"
#include "shaders/shared/group_sizes.shared.h"

namespace volgi::screen {

SideSkyGl::SideSkyGl() : program_(gl::Program::compute("screen/sources/sky/side_sky.comp.glsl")) {}

void SideSkyGl::run(const VoxelGridGl& voxels, const SkyMaps& maps, const SideFluxGl& flux, gl::PassTimer& timer,
                    int sample) {
  const auto scope = timer.scope(name);
  voxels.bind();
  maps.bind(program_);
  flux.emitted().bind_storage(SKY_FLUX_SLOT);
  program_.set("stride", std::max(maps.part_count() / SideSkyCpu::kRays, 1));
  program_.set("sample_index", sample);
  program_.use();
  gl::dispatch_linear(voxels.side_capacity, LINEAR_GROUP);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
}

}  // namespace volgi::screen
