#include "screen/lights/resample/choose_virtual_lights.h"

#include <algorithm>
#include <numeric>

#include "shaders/shared/virtual_light.shared.h"

namespace volgi::screen {

namespace {

constexpr int kReceivers = 256;  // of shaders/screen/lights/resample/light_candidates.glsl, two vec4 each

}  // namespace

ChooseVirtualLights::ChooseVirtualLights(int one_of)
    : one_of_(one_of),
      receivers_(size_t(kReceivers) * 8 * sizeof(float)),
      receivers_program_(gl::Program::compute("screen/lights/resample/choose_receivers.comp.glsl")),
      weigh_(gl::Program::compute("screen/lights/resample/choose_weigh.comp.glsl")),
      choose_(gl::Program::compute("screen/lights/resample/choose_virtual_lights.comp.glsl")),
      sum_("screen/lights/resample/choose_sum.comp.glsl", {}) {}

void ChooseVirtualLights::make_room(const VirtualLightListGl& candidates) {
  lights_.of_light.clear();
  for (const int of_light : candidates.of_light) lights_.of_light.push_back(of_light / one_of_);
  lights_.reflected = std::accumulate(lights_.of_light.begin(), lights_.of_light.end(), 0);
  lights_.emitted = candidates.emitted / one_of_;
  const size_t bytes = padded_count(lights_) * sizeof(shared::VirtualLight);
  if (lights_.buffer.bytes() != bytes) lights_.buffer = gl::Buffer(bytes);
  lights_.buffer.clear();
  gl::reserve(ranges_, size_t(std::max(lights_.count(), 1)) * 2 * sizeof(float));
  gl::reserve(weights_, size_t(std::max(candidates.count(), 1)) * 2 * sizeof(float));
}

void ChooseVirtualLights::run(const VirtualLightListGl& candidates, const GBuffer& gbuffer, gl::PassTimer& timer) {
  const auto scope = timer.scope(name);
  make_room(candidates);
  candidates.buffer.bind_storage(0);
  receivers_.bind_storage(1);
  weights_.bind_storage(2);
  lights_.buffer.bind_storage(3);
  ranges_.bind_storage(4);
  gbuffer.bind();
  receivers_program_.use();
  gl::dispatch_linear(kReceivers, 64);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  int first = 0;
  for (const int count : lights_.of_light) {
    choose(first * one_of_, count * one_of_, first, count);
    first += count;
  }
  choose(first * one_of_, lights_.emitted * one_of_, first, lights_.emitted);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_UNIFORM_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
}

void ChooseVirtualLights::choose(int first_candidate, int candidates, int first, int count) {
  if (count == 0) return;
  for (const gl::Program* program : {&weigh_, &choose_}) {
    program->set("first_candidate", first_candidate);
    program->set("candidate_count", candidates);
    program->set("flux_share", kFluxShare);
  }
  sum_.set("first_candidate", first_candidate);
  sum_.set("candidate_count", candidates);
  weigh_.use();
  gl::dispatch_linear(size_t(candidates), 64);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  sum_.run();
  choose_.set("first", first);
  choose_.set("count", count);
  choose_.use();
  gl::dispatch_linear(size_t(count), 64);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

}  // namespace volgi::screen
