#include "screen/gather/interleaved/area_light_gather.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.h"
#include "shaders/screen/base/slots.shared.h"
#include "shaders/screen/gather/interleaved/slots.shared.h"
#include "shaders/screen/visibility/area_maps/slots.shared.h"
#include "shaders/shared/disk_to_point.shared.h"
#include "shaders/shared/group_sizes.shared.h"

namespace volgi::screen {

namespace {

constexpr size_t kLightBytes = sizeof(shared::VirtualLight);
constexpr GLsizeiptr kBlockBytes = VIRTUAL_LIGHTS_PER_BLOCK * kLightBytes;
constexpr int kAlign = 16;  // lights: 768 bytes, a multiple of every offset alignment that GL allows

gl::Texture picture(glm::ivec2 size) { return gl::Texture::make_2d(GL_RGBA32F, size.x, size.y); }

void wait_for_pictures() { glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT); }

}  // namespace

void AreaLightGather::check(const AreaLightGatherOptions& options) {
  const int n = options.interleave;
  if (n != 1 && n != 2 && n != 4 && n != 8)
    throw Error(ExitCode::usage, "interleaving of the area lights' gather: 1, 2, 4 or 8, not " + std::to_string(n));
  if (!(options.exact_rows >= 0.0f && std::isfinite(options.exact_rows)))
    throw Error(ExitCode::usage, "rows of pixels that are gathered again must be 0 or more");
}

AreaLightGather::AreaLightGather(glm::ivec2 size, const AreaLightGatherOptions& options, const AreaLightShadow& shadow)
    : options_(options), size_(size) {
  check(options);
  direct_ = picture(size);
  indirect_ = picture(size);
  direct_.clear({0.0f, 0.0f, 0.0f, 0.0f});
  std::vector<std::string> defines{shadow.define()};
  if (options_.near_zone >= DISK_FAR_AREAS) defines.emplace_back("FROM_AFAR");
  arrange_ = gl::Program::compute("screen/gather/interleaved/arrange_lights.comp.glsl");
  gather_ = gl::Program::compute("screen/gather/interleaved/area_light_gather.comp.glsl", defines);
  if (options_.interleave == 1) return;
  direct_irradiance_ = picture(size);
  indirect_irradiance_ = picture(size);
  blur_.emplace(size, options_.interleave, options_.blur);
  worst_.emplace(size);
  defines.emplace_back("LISTED");
  gather_listed_ = gl::Program::compute("screen/gather/interleaved/area_light_gather.comp.glsl", defines);
}

void AreaLightGather::run(const GBuffer& gbuffer, const VirtualLightListGl& lights,
                          const VirtualAreaLights& area_lights, const ParaboloidDepthMaps& maps,
                          const AreaLightShadow& shadow, float scene_diagonal_m, gl::PassTimer& timer, int sample) {
  with_direct_ = lights.emitted > 0;
  {
    const auto scope = timer.scope(arrange_name);
    arrange(lights, area_lights);
  }
  gbuffer.bind();
  area_lights.buffer().bind_uniform(AREA_LIGHTS_BLOCK);
  const auto set_up = [&](const gl::Program& program) {
    program.set("near_zone", options_.near_zone);
    program.set("area_light_count", area_lights.count());
    program.set("with_direct", with_direct_ ? 1 : 0);
    shadow.bind(maps, program);
  };
  {
    const auto scope = timer.scope(name);
    set_up(gather_);
    gather_interleaved(sample);
  }
  if (options_.interleave == 1) return;
  {
    const auto scope = timer.scope(blur_name);
    blur_->run(indirect_irradiance_, indirect_, GeometryBlur::Estimate::anew, scene_diagonal_m);
    if (with_direct_) blur_->run(direct_irradiance_, direct_, GeometryBlur::Estimate::adds, scene_diagonal_m);
  }
  if (options_.exact_rows > 0.0f) {
    const auto scope = timer.scope(exact_name);
    worst_->find(blur_->error_estimate(), options_.exact_rows);
    set_up(gather_listed_);
    gather_listed();
  }
}

void AreaLightGather::arrange(const VirtualLightListGl& lights, const VirtualAreaLights& area_lights) {
  light_count_ = lights.count();
  gl::reserve(arranged_, size_t(light_count_ + VIRTUAL_LIGHTS_PER_BLOCK) * kLightBytes);  // blocks are bound whole
  lights.buffer.bind_storage(VIRTUAL_LIGHTS_SLOT);
  area_lights.order().bind_storage(LIGHT_ORDER_SLOT);
  area_lights.cluster_of().bind_storage(CLUSTER_OF_SLOT);
  arranged_.bind_storage(ARRANGED_LIGHTS_SLOT);
  arrange_.set("light_count", light_count_);
  arrange_.use();
  gl::dispatch_linear(size_t(light_count_), LINEAR_GROUP);
  glMemoryBarrier(GL_UNIFORM_BARRIER_BIT);
}

/// Dispatches `program` for each block of the lights; the first begins the sum, the last ends it. At least one
/// dispatch, which leaves black where there are no lights.
template <class Dispatch>
void AreaLightGather::gather(const gl::Program& program, Range lights, const Dispatch& dispatch) {
  int first = lights.first;
  do {
    const int block = first / kAlign * kAlign;
    const int end = std::min(block + VIRTUAL_LIGHTS_PER_BLOCK, lights.end);
    glBindBufferRange(GL_UNIFORM_BUFFER, VIRTUAL_LIGHTS_BLOCK, arranged_.id(), GLintptr(block) * GLintptr(kLightBytes),
                      kBlockBytes);
    program.set("first_of_block", block);
    program.set("first_light", first);
    program.set("end_light", end);
    program.set("begins", first == lights.first ? 1 : 0);
    program.set("ends", end == lights.end ? 1 : 0);
    dispatch();
    if (end < lights.end) wait_for_pictures();
    first = end;
  } while (first < lights.end);
}

void AreaLightGather::gather_interleaved(int sample) {
  const int n = options_.interleave;
  (n > 1 ? indirect_irradiance_ : indirect_).bind_image(INDIRECT_IMAGE, GL_READ_WRITE);
  (n > 1 ? direct_irradiance_ : direct_).bind_image(DIRECT_IMAGE, GL_READ_WRITE);
  gather_.set("interleave", n);
  gather_.use();
  const auto first_of = [&](int subset) { return int(int64_t(subset) * light_count_ / (n * n)); };
  for (int subset = 0; subset < n * n; ++subset) {
    gather_.set("offset", place_in_block((subset + sample) % (n * n), n));
    gather(gather_, {first_of(subset), first_of(subset + 1)}, [&] {
      gl::dispatch({(size_.x + n - 1) / n, (size_.y + n - 1) / n, 1}, {SQUARE_GROUP, SQUARE_GROUP, 1});
    });
  }
  wait_for_pictures();
}

void AreaLightGather::gather_listed() {
  indirect_.bind_image(INDIRECT_IMAGE, GL_READ_WRITE);
  direct_.bind_image(DIRECT_IMAGE, GL_READ_WRITE);
  worst_->list().bind(PIXEL_LIST_SLOT);
  gather_listed_.set("interleave", 1);
  gather_listed_.use();
  gather(gather_listed_, {0, light_count_}, [this] { worst_->list().dispatch(); });
  wait_for_pictures();
}

size_t AreaLightGather::bytes() const {
  const size_t texel_bytes = options_.interleave > 1 ? 4 * 16 : 2 * 16;
  return texel_bytes * size_t(size_.x) * size_t(size_.y) + arranged_.bytes() + (blur_ ? blur_->bytes() : 0) +
         (worst_ ? worst_->bytes() : 0);
}

}  // namespace volgi::screen
