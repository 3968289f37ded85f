#include "screen/sources/sky/sky_gather.h"

#include "shaders/screen/base/slots.shared.h"
#include "shaders/screen/sources/sky/slots.shared.h"
#include "shaders/shared/group_sizes.shared.h"

namespace volgi::screen {
namespace {

constexpr const char* SHADER = "screen/sources/sky/sky_gather.comp.glsl";

void wait_for_pictures() { glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT); }

}  // namespace

SkyGather::SkyGather(glm::ivec2 size, const SkyOptions& options)
    : size_(size),
      options_(options),
      radiance_(gl::Texture::make_2d(GL_RGBA32F, size.x, size.y)),
      gather_(gl::Program::compute(SHADER)) {
  if (options_.interleave == 1) return;
  irradiance_ = gl::Texture::make_2d(GL_RGBA32F, size.x, size.y);
  blur_.emplace(size, options_.interleave, GeometryBlurOptions());
  worst_.emplace(size);
  gather_listed_ = gl::Program::compute(SHADER, {"LISTED"});
}

void SkyGather::run(const GBuffer& gbuffer, const SkyMaps& maps, float scene_diagonal_m, gl::PassTimer& timer,
                    int sample) {
  gbuffer.bind();
  {
    const auto scope = timer.scope(name);
    gather(maps, sample);
    if (blur_) blur_->run(irradiance_, radiance_, GeometryBlur::Estimate::anew, scene_diagonal_m);
  }
  if (!blur_ || !(options_.exact_rows > 0.0f)) return;
  const auto scope = timer.scope(exact_name);
  worst_->find(blur_->error_estimate(), options_.exact_rows);
  gather_again(maps);
}

void SkyGather::gather(const SkyMaps& maps, int sample) {
  const int n = options_.interleave;
  maps.bind(gather_);
  (n > 1 ? irradiance_ : radiance_).bind_image(SKY_IRRADIANCE_IMAGE, GL_WRITE_ONLY);
  gather_.set("interleave", n);
  gather_.use();
  for (int subset = 0; subset < n * n; ++subset) {
    gather_.set("subset", subset);
    gather_.set("offset", place_in_block((subset + sample) % (n * n), n));
    gl::dispatch({(size_.x + n - 1) / n, (size_.y + n - 1) / n, 1}, {SQUARE_GROUP, SQUARE_GROUP, 1});
  }
  wait_for_pictures();
}

void SkyGather::gather_again(const SkyMaps& maps) {
  maps.bind(gather_listed_);
  radiance_.bind_image(SKY_IRRADIANCE_IMAGE, GL_WRITE_ONLY);
  worst_->list().bind(PIXEL_LIST_SLOT);
  gather_listed_.set("interleave", 1);
  gather_listed_.set("subset", 0);
  gather_listed_.use();
  worst_->list().dispatch();
  wait_for_pictures();
}

size_t SkyGather::bytes() const {
  const size_t pictures = blur_ ? 2 : 1;
  return pictures * 16 * size_t(size_.x) * size_t(size_.y) + (blur_ ? blur_->bytes() + worst_->bytes() : 0);
}

}  // namespace volgi::screen
