#include "screen/lights/resample/virtual_light_parts.h"

#include "shaders/shared/near_light.shared.h"

namespace volgi::screen {

VirtualLightParts::VirtualLightParts()
    : program_(gl::Program::compute("screen/lights/resample/virtual_light_parts.comp.glsl")) {}

void VirtualLightParts::run(const ReflectiveShadowMap& maps, const VirtualLights& candidates,
                            const ChooseVirtualLights& chosen, gl::PassTimer& timer) {
  const auto scope = timer.scope(name);
  const VirtualLightListGl& lights = chosen.lights();
  gl::reserve(pieces_, padded_count(lights) * LIGHT_PIECES * sizeof(shared::LightPiece));
  gl::reserve(near_lights_, padded_count(lights) * sizeof(shared::NearLight));
  const auto bind = [&] {
    lights.buffer.bind_storage(0);
    candidates.buffer().bind_storage(5);
    chosen.ranges().bind_storage(6);
    pieces_.bind_storage(7);
    near_lights_.bind_storage(8);
  };
  int first = 0;
  for (int light = 0; light < int(lights.of_light.size()); ++light) {
    const int count = lights.of_light[size_t(light)];
    if (count == 0) continue;
    maps.bind(light);
    bind();
    const double measure = candidates.set_sampling(program_, maps, light);
    run_source(light, first, count, candidates.along_curve(), measure, chosen.one_of());
    first += count;
  }
  bind();
  if (lights.emitted > 0) run_source(-1, first, lights.emitted, false, 0.0, chosen.one_of());
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_UNIFORM_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
}

void VirtualLightParts::run_source(int light, int first, int count, bool along_curve, double measure, int one_of) {
  program_.set("light", light);
  program_.set("first", first);
  program_.set("count", count);
  program_.set("first_candidate", first * one_of);
  program_.set("candidate_count", count * one_of);
  program_.set("along_curve", along_curve ? 1 : 0);
  program_.set("measure", float(measure));
  program_.use();
  gl::dispatch_linear(size_t(count), 64);
}

}  // namespace volgi::screen
