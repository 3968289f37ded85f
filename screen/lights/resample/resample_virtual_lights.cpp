#include "screen/lights/resample/resample_virtual_lights.h"

#include <algorithm>
#include <numeric>

#include "core/sample_sequence.h"
#include "shaders/screen/lights/resample/resample.shared.h"
#include "shaders/screen/lights/resample/slots.shared.h"
#include "shaders/shared/group_sizes.shared.h"
#include "shaders/shared/virtual_light.shared.h"

namespace volgi::screen {

ResampleVirtualLights::ResampleVirtualLights(int candidates_per_light)
    : candidates_per_light_(candidates_per_light),
      receivers_(size_t(RESAMPLE_RECEIVERS) * RESAMPLE_FLOATS_PER_RECEIVER * sizeof(float)),
      receivers_program_(gl::Program::compute("screen/lights/resample/resample_receivers.comp.glsl")),
      weigh_(gl::Program::compute("screen/lights/resample/resample_weights.comp.glsl")),
      resample_(gl::Program::compute("screen/lights/resample/resample_virtual_lights.comp.glsl")),
      sum_("screen/lights/resample/resample_sum.comp.glsl", {}) {}

void ResampleVirtualLights::make_room(const VirtualLightListGl& candidates) {
  lights_.of_light.clear();
  for (const int of_light : candidates.of_light) lights_.of_light.push_back(of_light / candidates_per_light_);
  lights_.reflected = std::accumulate(lights_.of_light.begin(), lights_.of_light.end(), 0);
  lights_.emitted = candidates.emitted / candidates_per_light_;
  const size_t bytes = padded_count(lights_) * sizeof(shared::VirtualLight);
  if (lights_.buffer.bytes() != bytes) lights_.buffer = gl::Buffer(bytes);
  lights_.buffer.clear();
  gl::reserve(ranges_, size_t(std::max(lights_.count(), 1)) * 2 * sizeof(float));
  gl::reserve(weights_, size_t(std::max(candidates.count(), 1)) * 2 * sizeof(float));
}

void ResampleVirtualLights::run(const VirtualLightListGl& candidates, const GBuffer& gbuffer, gl::PassTimer& timer,
                                int sample) {
  const auto scope = timer.scope(name);
  make_room(candidates);
  candidates.buffer.bind_storage(CANDIDATES_SLOT);
  receivers_.bind_storage(RECEIVERS_SLOT);
  weights_.bind_storage(CANDIDATE_WEIGHTS_SLOT);
  lights_.buffer.bind_storage(CHOSEN_LIGHTS_SLOT);
  ranges_.bind_storage(CHOSEN_RANGES_SLOT);
  gbuffer.bind();
  receivers_program_.set("first_point", GLuint(sample) * RESAMPLE_RECEIVERS);
  resample_.set("step_shift", float(sample_shift(SampleChoice::chosen_lights, std::uint64_t(sample))));
  receivers_program_.use();
  gl::dispatch_linear(RESAMPLE_RECEIVERS, LINEAR_GROUP);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  int first = 0;
  for (const int count : lights_.of_light) {
    resample(first * candidates_per_light_, count * candidates_per_light_, first, count);
    first += count;
  }
  resample(first * candidates_per_light_, lights_.emitted * candidates_per_light_, first, lights_.emitted);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_UNIFORM_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
}

void ResampleVirtualLights::resample(int first_candidate, int candidates, int first, int count) {
  if (count == 0) return;
  for (const gl::Program* program : {&weigh_, &resample_}) {
    program->set("first_candidate", first_candidate);
    program->set("candidate_count", candidates);
    program->set("flux_share", kFluxShare);
  }
  sum_.set("first_candidate", first_candidate);
  sum_.set("candidate_count", candidates);
  weigh_.use();
  gl::dispatch_linear(size_t(candidates), LINEAR_GROUP);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  sum_.run();
  resample_.set("first", first);
  resample_.set("count", count);
  resample_.use();
  gl::dispatch_linear(size_t(count), LINEAR_GROUP);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

}  // namespace volgi::screen
