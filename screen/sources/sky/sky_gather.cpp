#include "screen/sources/sky/sky_gather.h"

#include "shaders/screen/base/slots.shared.h"
#include "shaders/screen/sources/sky/slots.shared.h"

namespace volgi::screen {
namespace {

// Subsets of the parts that are looked at one after the other: so many maps stay in a cache.
constexpr int SUBSETS = 8;

}  // namespace

SkyGather::SkyGather(glm::ivec2 size, const SkyOptions& options)
    : pixels_(size, {.tolerance = options.tolerance}),
      radiance_(gl::Texture::make_2d(GL_RGBA32F, size.x, size.y)),
      program_(gl::Program::compute("screen/sources/sky/sky_gather.comp.glsl")) {}

void SkyGather::run(const GBuffer& gbuffer, const SkyMaps& maps, gl::PassTimer& timer) {
  maps_ = &maps;
  SmoothLight* const alone = this;
  pixels_.run(gbuffer, {&alone, 1}, timer);
  maps_ = nullptr;
}

void SkyGather::gather(const WorkList& list, int step_px, std::span<const gl::Texture> irradiance,
                       gl::PassTimer& timer) {
  const auto scope = timer.scope(name);
  maps_->bind(program_);
  list.bind(PIXEL_LIST_SLOT);
  irradiance[0].bind_image(SKY_IRRADIANCE_IMAGE, GL_READ_WRITE);
  program_.set("subsets", SUBSETS);
  program_.set("step_px", step_px);
  program_.set("takers", step_px <= 2 ? 2 : 1);
  for (int subset = 0; subset < SUBSETS; ++subset) {
    program_.set("subset", subset);
    program_.use();
    list.dispatch();
    glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
  }
}

size_t SkyGather::bytes() const {
  return pixels_.bytes() + sizeof(glm::vec4) * size_t(radiance_.size().x) * size_t(radiance_.size().y);
}

}  // namespace volgi::screen
