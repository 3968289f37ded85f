#include "screen/area_light_gather.h"

#include <algorithm>
#include <cassert>

namespace volgi::screen {

namespace {

constexpr size_t kLightBytes = sizeof(shared::VirtualLight);
constexpr GLsizeiptr kBlockBytes = VIRTUAL_LIGHTS_A_BLOCK * kLightBytes;
constexpr int kAlign = 16;  // lights: 768 bytes, a multiple of every offset alignment that GL allows

gl::Texture picture(glm::ivec2 size) { return gl::Texture::make_2d(GL_RGBA32F, size.x, size.y); }

}  // namespace

AreaLightGather::AreaLightGather(glm::ivec2 size, const AreaLightGatherOptions& options, const AreaLightShadow& shadow)
    : options_(options),
      size_(size),
      direct_(picture(size)),
      indirect_(picture(size)),
      arrange_(gl::Program::compute("screen/arrange_lights.comp.glsl")),
      gather_(gl::Program::compute("screen/area_light_gather.comp.glsl", {shadow.define()})) {
  assert(options.interleave >= 1);
  direct_.clear({0.0f, 0.0f, 0.0f, 0.0f});
  if (options_.interleave == 1) return;
  direct_irradiance_ = picture(size);
  indirect_irradiance_ = picture(size);
  half_blurred_ = picture(size);
  blur_ = gl::Program::compute("screen/geometry_blur.comp.glsl");
}

void AreaLightGather::run(const GBuffer& gbuffer, const VirtualLightListGl& lights,
                          const VirtualAreaLights& area_lights, const ParaboloidDepthMaps& maps,
                          const AreaLightShadow& shadow, float scene_diagonal_m, gl::PassTimer& timer) {
  with_direct_ = lights.emitted > 0;
  {
    const auto scope = timer.scope(arrange_name);
    arrange(lights, area_lights);
  }
  {
    const auto scope = timer.scope(name);
    shadow.bind(maps, gather_);
    gather(gbuffer, area_lights);
  }
  if (options_.interleave > 1) {
    const auto scope = timer.scope(blur_name);
    blur(gbuffer, indirect_irradiance_, half_blurred_, indirect_, scene_diagonal_m);
    if (with_direct_) blur(gbuffer, direct_irradiance_, half_blurred_, direct_, scene_diagonal_m);
  }
}

void AreaLightGather::arrange(const VirtualLightListGl& lights, const VirtualAreaLights& area_lights) {
  const int subsets = options_.interleave * options_.interleave;
  lights_a_subset_ = ((lights.count() + subsets - 1) / subsets + kAlign - 1) / kAlign * kAlign;
  const int places = subsets * lights_a_subset_;
  // Uniform blocks are bound whole, from any subset on.
  const size_t bytes = size_t(places + VIRTUAL_LIGHTS_A_BLOCK) * kLightBytes;
  if (arranged_.bytes() != bytes) arranged_ = gl::Buffer(bytes);
  lights.buffer.bind_storage(0);
  area_lights.order().bind_storage(1);
  area_lights.cluster_of().bind_storage(2);
  arranged_.bind_storage(3);
  arrange_.set("light_count", lights.count());
  arrange_.set("subsets", subsets);
  arrange_.set("lights_a_subset", lights_a_subset_);
  arrange_.use();
  gl::dispatch({places, 1, 1}, {64, 1, 1});
  glMemoryBarrier(GL_UNIFORM_BARRIER_BIT);
}

void AreaLightGather::gather(const GBuffer& gbuffer, const VirtualAreaLights& area_lights) {
  const int n = options_.interleave;
  gbuffer.position().bind(0);
  gbuffer.normals().bind(1);
  gbuffer.albedo().bind(2);
  (n > 1 ? indirect_irradiance_ : indirect_).bind_image(0, GL_READ_WRITE);
  (n > 1 ? direct_irradiance_ : direct_).bind_image(1, GL_READ_WRITE);
  area_lights.buffer().bind_uniform(1);
  gather_.set("interleave", n);
  gather_.set("with_direct", with_direct_ ? 1 : 0);
  gather_.use();
  for (int start = 0; start < std::max(lights_a_subset_, 1); start += VIRTUAL_LIGHTS_A_BLOCK) {
    gather_.set("light_count", std::min(lights_a_subset_ - start, VIRTUAL_LIGHTS_A_BLOCK));
    gather_.set("begins", start == 0 ? 1 : 0);
    for (int subset = 0; subset < n * n; ++subset) {
      const GLintptr first = GLintptr(subset) * lights_a_subset_ + start;
      glBindBufferRange(GL_UNIFORM_BUFFER, 0, arranged_.id(), first * GLintptr(kLightBytes), kBlockBytes);
      gather_.set("offset", glm::ivec2(subset % n, subset / n));
      gl::dispatch({(size_.x + n - 1) / n, (size_.y + n - 1) / n, 1}, {8, 8, 1});
    }
    glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT);
  }
}

void AreaLightGather::blur(const GBuffer& gbuffer, const gl::Texture& from, const gl::Texture& half,
                           const gl::Texture& to, float scene_diagonal_m) {
  gbuffer.position().bind(0);
  gbuffer.normals().bind(1);
  gbuffer.albedo().bind(2);
  blur_.set("interleave", options_.interleave);
  blur_.set("most_distance_m", options_.blur_distance * scene_diagonal_m);
  blur_.set("least_cosine", options_.blur_cosine);
  blur_.set("off_plane", options_.blur_off_plane);
  blur_.use();
  const auto along = [&](glm::ivec2 axis, const gl::Texture& source, const gl::Texture& target, bool ends) {
    source.bind(3);
    target.bind_image(0, GL_WRITE_ONLY);
    blur_.set("axis", axis);
    blur_.set("ends", ends ? 1 : 0);
    gl::dispatch({size_.x, size_.y, 1}, {8, 8, 1});
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
  };
  along({1, 0}, from, half, false);
  along({0, 1}, half, to, true);
}

size_t AreaLightGather::bytes() const {
  const size_t pictures = options_.interleave > 1 ? 5 : 2;
  return pictures * 16 * size_t(size_.x) * size_t(size_.y) + arranged_.bytes();
}

}  // namespace volgi::screen
