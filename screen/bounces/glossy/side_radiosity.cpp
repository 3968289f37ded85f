#include "screen/bounces/glossy/side_radiosity.h"

#include "shaders/screen/bounces/glossy/slots.shared.h"
#include "shaders/shared/group_sizes.shared.h"

namespace volgi::screen {

SideRadiosity::SideRadiosity()
    : program_(gl::Program::compute("screen/bounces/glossy/side_radiosity.comp.glsl")),
      punctual_(gl::Program::compute("screen/bounces/glossy/side_punctual.comp.glsl")) {}

void SideRadiosity::run(const FrameVolume& volume, const ReflectiveShadowMap& maps, std::optional<int> bounces,
                        gl::PassTimer& timer) {
  const FrameVolume::SentFlux flux = volume.light_in();
  // Of lamps and emission, whose light the sides meet first: once reflected. Of virtual lights: twice. The rest: three
  // times or more, and once more than it has been when it arrives.
  const bool once = !bounces || *bounces >= 1, twice = !bounces || *bounces >= 2;
  const gl::Buffer* but_last = bounces && twice ? volume.indirect_irradiance_but_last(timer) : nullptr;
  const auto scope = timer.scope(name);
  const VoxelGridGl& voxels = volume.voxels();
  gl::reserve(radiosity_, sizeof(glm::vec4) * voxels.side_capacity);
  const gl::Buffer& indirect = but_last != nullptr ? *but_last : *volume.indirect_irradiance();
  const bool has_punctual = flux.punctual != nullptr && twice, has_emitted = flux.emitted != nullptr && once;
  const bool has_direct = twice && volume.first_is_apart() && volume.direct_irradiance() != nullptr;
  voxels.bind();
  (has_punctual ? *flux.punctual : indirect).bind_storage(GLOSSY_PUNCTUAL_FLUX_SLOT);
  (has_emitted ? *flux.emitted : indirect).bind_storage(GLOSSY_EMITTED_FLUX_SLOT);
  (has_direct ? *volume.direct_irradiance() : indirect).bind_storage(GLOSSY_DIRECT_IRRADIANCE_SLOT);
  indirect.bind_storage(GLOSSY_INDIRECT_IRRADIANCE_SLOT);
  radiosity_.bind_storage(GLOSSY_RADIOSITY_SLOT);
  program_.set("has_punctual", has_punctual ? 1 : 0);
  program_.set("has_emitted", has_emitted ? 1 : 0);
  program_.set("has_direct", has_direct ? 1 : 0);
  program_.set("has_indirect", twice ? 1 : 0);
  program_.use();
  gl::dispatch_linear(voxels.side_capacity, LINEAR_GROUP);
  for (int light = 0; once && light < maps.light_count(); ++light) {
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    maps.bind(light);
    punctual_.set("light", light);
    punctual_.use();
    gl::dispatch_linear(voxels.side_capacity, LINEAR_GROUP);
  }
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

}  // namespace volgi::screen
