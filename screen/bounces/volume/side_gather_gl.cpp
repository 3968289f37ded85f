#include "screen/bounces/volume/side_gather_gl.h"

#include <algorithm>

#include "shaders/screen/base/slots.shared.h"
#include "shaders/screen/bounces/volume/slots.shared.h"
#include "shaders/screen/visibility/area_maps/slots.shared.h"
#include "shaders/shared/group_sizes.shared.h"

namespace volgi::screen {

SideGatherGl::SideGatherGl(const AreaLightShadow& shadow)
    : program_(gl::Program::compute("screen/bounces/volume/side_gather.comp.glsl", {shadow.define()})) {}

void SideGatherGl::run(const VoxelGridGl& voxels, const FirstBounce& first_bounce, const SideFluxGl& flux,
                       gl::PassTimer& timer) {
  const auto scope = timer.scope(name);
  const VirtualLightListGl& lights = first_bounce.lights;
  voxels.bind();
  first_bounce.clusters.area_lights.buffer().bind_uniform(AREA_LIGHTS_BLOCK);
  lights.buffer.bind_storage(VIRTUAL_LIGHTS_SLOT);
  first_bounce.clusters.area_lights.order().bind_storage(LIGHT_ORDER_SLOT);
  first_bounce.clusters.area_lights.cluster_of().bind_storage(CLUSTER_OF_SLOT);
  flux.emitted().bind_storage(GATHERED_EMITTED_SLOT);
  flux.punctual().bind_storage(GATHERED_PUNCTUAL_SLOT);
  first_bounce.clusters.shadow.bind(first_bounce.clusters.maps, program_);
  if (first_bounce.subdivision != nullptr) {
    first_bounce.subdivision->sublights().bind_storage(SIDE_SUBLIGHTS_SLOT);
    first_bounce.subdivision->near_lights().bind_storage(SIDE_NEAR_LIGHTS_SLOT);
  }
  program_.set("apart", first_bounce.subdivision != nullptr && first_bounce.subdivision->apart() ? 1 : 0);
  program_.set("zone", first_bounce.subdivision != nullptr ? first_bounce.near_zone : 0.0f);
  program_.set("light_count", lights.count());
  program_.use();
  gl::dispatch_linear(voxels.side_capacity, LINEAR_GROUP);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
}

}  // namespace volgi::screen
