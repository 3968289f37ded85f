#include "screen/display/exposure_meter.h"

#include <vector>

#include "core/exposure.h"
#include "shaders/screen/display/exposure_meter.shared.h"

namespace volgi::screen {

namespace {
constexpr size_t BYTES = sizeof(glm::vec4) * METERED_EDGE * METERED_EDGE;
constexpr size_t SLOTS = 4;
}  // namespace

ExposureMeter::ExposureMeter()
    : samples_(BYTES),
      readback_(BYTES, SLOTS),
      program_(gl::Program::compute("screen/display/exposure_meter.comp.glsl")),
      image_(METERED_EDGE, METERED_EDGE) {}

void ExposureMeter::run(const gl::Texture& radiance, gl::PassTimer& timer) {
  while (readback_.ready()) take();
  if (readback_.pending() == SLOTS) return;  // this picture goes unmetered
  const auto scope = timer.scope(name);
  radiance.bind(METERED_RADIANCE_UNIT);
  samples_.bind_storage(METERED_SAMPLES_SLOT);
  program_.use();
  gl::dispatch_linear(size_t(METERED_EDGE) * METERED_EDGE, METERED_EDGE);
  readback_.push(samples_);
}

void ExposureMeter::take() {
  std::vector<glm::vec4> samples(image_.pixels.size());
  readback_.pop(samples.data());
  for (size_t k = 0; k < samples.size(); ++k) image_.pixels[k] = glm::vec3(samples[k]);
  exposure_ev_ = automatic_exposure_ev(image_);
}

std::optional<float> ExposureMeter::exposure_ev() {
  while (readback_.ready()) take();
  return exposure_ev_;
}

std::optional<float> ExposureMeter::wait() {
  while (readback_.pending() > 0) take();
  return exposure_ev_;
}

}  // namespace volgi::screen
