#include "screen/lights/resample/virtual_light_subdivision.h"

#include "shaders/screen/lights/resample/slots.shared.h"
#include "shaders/screen/lights/rsm/slots.shared.h"
#include "shaders/shared/group_sizes.shared.h"
#include "shaders/shared/near_light.shared.h"

namespace volgi::screen {

VirtualLightSubdivision::VirtualLightSubdivision()
    : program_(gl::Program::compute("screen/lights/resample/virtual_light_subdivision.comp.glsl")) {}

void VirtualLightSubdivision::run(const ReflectiveShadowMap& maps, const VirtualLights& candidates,
                                  const ResampleVirtualLights& chosen, gl::PassTimer& timer, int sample) {
  const auto scope = timer.scope(name);
  apart_ = sample > 0;
  const VirtualLightListGl& lights = chosen.lights();
  program_.set("apart", apart_ ? 1 : 0);
  gl::reserve(sublights_, padded_count(lights) * SUBLIGHTS_PER_LIGHT * sizeof(shared::SubLight));
  gl::reserve(near_lights_, padded_count(lights) * sizeof(shared::NearLight));
  const auto bind = [&] {
    lights.buffer.bind_storage(SAMPLED_LIGHTS_SLOT);
    candidates.buffer().bind_storage(DIVIDED_CANDIDATES_SLOT);
    chosen.ranges().bind_storage(DIVIDED_RANGES_SLOT);
    sublights_.bind_storage(MADE_SUBLIGHTS_SLOT);
    near_lights_.bind_storage(MADE_NEAR_LIGHTS_SLOT);
  };
  int first = 0;
  for (int light = 0; light < int(lights.of_light.size()); ++light) {
    const int count = lights.of_light[size_t(light)];
    if (count == 0) continue;
    if (light >= maps.light_count()) {  // of the sky
      bind();
      run_source(-1, first, count, false, 0.0, chosen.candidates_per_light());
      first += count;
      continue;
    }
    maps.bind(light);
    bind();
    const double measure = candidates.set_sampling(program_, maps, light);
    run_source(light, first, count, candidates.along_curve(), measure, chosen.candidates_per_light());
    first += count;
  }
  bind();
  if (lights.emitted > 0) run_source(-1, first, lights.emitted, false, 0.0, chosen.candidates_per_light());
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_UNIFORM_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
}

void VirtualLightSubdivision::run_source(int light, int first, int count, bool along_curve, double measure,
                                         int candidates_per_light) {
  program_.set("light", light);
  program_.set("first", first);
  program_.set("count", count);
  program_.set("first_candidate", first * candidates_per_light);
  program_.set("candidate_count", count * candidates_per_light);
  program_.set("along_curve", along_curve ? 1 : 0);
  program_.set("measure", float(measure));
  program_.use();
  gl::dispatch_linear(size_t(count), LINEAR_GROUP);
}

}  // namespace volgi::screen
