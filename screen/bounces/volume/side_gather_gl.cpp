#include "screen/bounces/volume/side_gather_gl.h"

#include <algorithm>

namespace volgi::screen {

SideGatherGl::SideGatherGl(const AreaLightShadow& shadow)
    : program_(gl::Program::compute("screen/bounces/volume/side_gather.comp.glsl", {shadow.define()})) {}

void SideGatherGl::run(const VoxelGridGl& voxels, const FirstBounce& first_bounce, const SideFluxGl& flux,
                       gl::PassTimer& timer) {
  const auto scope = timer.scope(name);
  const VirtualLightListGl& lights = first_bounce.lights;
  voxels.bind();
  first_bounce.clusters.area_lights.buffer().bind_uniform(1);
  lights.buffer.bind_storage(0);
  first_bounce.clusters.area_lights.order().bind_storage(1);
  first_bounce.clusters.area_lights.cluster_of().bind_storage(2);
  flux.emitted().bind_storage(6);
  flux.punctual().bind_storage(7);
  first_bounce.clusters.shadow.bind(first_bounce.clusters.maps, program_);
  if (first_bounce.subdivision != nullptr) first_bounce.subdivision->sublights().bind_storage(8);
  program_.set("zone", first_bounce.subdivision != nullptr ? first_bounce.near_zone : 0.0f);
  program_.set("light_count", lights.count());
  program_.use();
  gl::dispatch_linear(voxels.side_capacity, 64);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
}

}  // namespace volgi::screen
