#include "screen/gather/strided/virtual_light_gather.h"

#include <algorithm>

#include "shaders/screen/base/slots.shared.h"
#include "shaders/screen/gather/strided/slots.shared.h"
#include "shaders/screen/visibility/negative/slots.shared.h"
#include "shaders/shared/group_sizes.shared.h"

namespace volgi::screen {

namespace {

constexpr GLsizeiptr kBlockBytes = VIRTUAL_LIGHTS_PER_BLOCK * sizeof(shared::VirtualLight);

gl::Texture picture(glm::ivec2 size) { return gl::Texture::make_2d(GL_RGBA32F, size.x, size.y); }

glm::ivec2 coarse_size(glm::ivec2 size, int stride) { return (size - 1 + stride - 1) / stride + 1; }

void bind_pixels(const GBuffer& gbuffer) { gbuffer.bind(); }

}  // namespace

VirtualLightGather::VirtualLightGather(glm::ivec2 size, const GatherOptions& options)
    : options_(options), size_(size), direct_(picture(size)), indirect_(picture(size)) {
  direct_.clear({0.0f, 0.0f, 0.0f, 0.0f});
  if (options_.stride == 1) return;
  coarse_direct_ = picture(coarse_size(size, options_.stride));
  coarse_indirect_ = picture(coarse_size(size, options_.stride));
  list_.reserve(size_t(size.x) * size_t(size.y));
  discontinuity_ = gl::Program::compute("screen/gather/strided/discontinuity.comp.glsl");
}

void VirtualLightGather::run(const GBuffer& gbuffer, const VirtualLightListGl& lights, const Visibility& visibility,
                             Part part, float scene_diagonal_m, gl::PassTimer& timer) {
  const int reflected = part == Part::all ? lights.reflected : 0;
  const bool with_direct = lights.emitted > 0;
  const auto gather_all = [&](Points points, const gl::Texture& indirect, const gl::Texture& direct) {
    const auto scope = timer.scope(name);
    bind_pixels(gbuffer);
    gather(points, lights, 0, reflected, visibility, indirect);
    if (with_direct) gather(points, lights, lights.reflected, lights.count(), {nullptr, visibility.maps}, direct);
  };
  if (options_.stride == 1) {
    gather_all(Points::grid, indirect_, direct_);
  } else {
    gather_all(Points::grid, coarse_indirect_, coarse_direct_);
    {
      const auto scope = timer.scope(discontinuity_name);
      find_discontinuities(gbuffer, with_direct, scene_diagonal_m);
    }
    gather_all(Points::list, indirect_, direct_);
  }
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
}

/// Without negative lights or maps, a program that does not declare them, as none are bound.
const gl::Program& VirtualLightGather::gather_program(Points points, bool in_the_air, const Visibility& visibility) {
  std::vector<std::string> defines;
  if (points == Points::list) defines.emplace_back("LISTED");
  if (in_the_air) defines.emplace_back("IN_THE_AIR");
  if (visibility.negative != nullptr) defines.emplace_back("NEGATIVE");
  if (visibility.maps != nullptr) defines.emplace_back("LIGHT_MAPS");
  const auto found = gather_.find(defines);
  if (found != gather_.end()) return found->second;
  return gather_.emplace(defines, gl::Program::compute("screen/gather/strided/virtual_light_gather.comp.glsl", defines))
      .first->second;
}

void VirtualLightGather::gather(Points points, const VirtualLightListGl& lights, int first, int end,
                                const Visibility& visibility, const gl::Texture& target) {
  const bool listed = points == Points::list;
  const NegativeLights* const negative = visibility.negative;
  const gl::Program& program = gather_program(points, lights.in_the_air, visibility);
  program.use();
  program.set("stride", listed ? 1 : options_.stride);
  target.bind_image(GATHERED_IMAGE, GL_READ_WRITE);
  if (listed) list_.bind(PIXEL_LIST_SLOT);
  if (negative != nullptr) negative->buffer().bind_uniform(NEGATIVE_LIGHTS_BLOCK);
  if (visibility.maps != nullptr) visibility.maps->bind(program);
  // At least one dispatch, which leaves black where there are no lights.
  const int first_block = first / VIRTUAL_LIGHTS_PER_BLOCK;
  const int last_block = std::max((end - 1) / VIRTUAL_LIGHTS_PER_BLOCK, first_block);
  for (int block = first_block; block <= last_block; ++block) {
    const int start = block * VIRTUAL_LIGHTS_PER_BLOCK;
    glBindBufferRange(GL_UNIFORM_BUFFER, VIRTUAL_LIGHTS_BLOCK, lights.buffer.id(), block * kBlockBytes, kBlockBytes);
    program.set("first_of_block", start);
    program.set("first_light", std::max(first - start, 0));
    program.set("end_light", std::min(end - start, VIRTUAL_LIGHTS_PER_BLOCK));
    program.set("begins", block == first_block ? 1 : 0);
    program.set("ends", block == last_block ? 1 : 0);
    if (negative != nullptr) program.set("negative_count", negative->count());
    if (listed) {
      list_.dispatch();
    } else {
      gl::dispatch_linear(size_t(target.size().x) * size_t(target.size().y), LINEAR_GROUP);
    }
    glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT);
  }
}

void VirtualLightGather::find_discontinuities(const GBuffer& gbuffer, bool with_direct, float scene_diagonal_m) {
  list_.clear();
  discontinuity_.use();
  discontinuity_.set("stride", options_.stride);
  discontinuity_.set("threshold", options_.threshold_rad);
  discontinuity_.set("contrast", options_.contrast);
  discontinuity_.set("unlike_distance_m", options_.distance * scene_diagonal_m);
  discontinuity_.set("with_direct", with_direct ? 1 : 0);
  bind_pixels(gbuffer);
  coarse_indirect_.bind(COARSE_INDIRECT_UNIT);
  coarse_direct_.bind(COARSE_DIRECT_UNIT);
  indirect_.bind_image(FINE_INDIRECT_IMAGE, GL_WRITE_ONLY);
  direct_.bind_image(FINE_DIRECT_IMAGE, GL_WRITE_ONLY);
  list_.bind(PIXEL_LIST_SLOT);
  gl::dispatch({coarse_indirect_.size().x, coarse_indirect_.size().y, 1}, {SQUARE_GROUP, SQUARE_GROUP, 1});
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
}

float VirtualLightGather::coarse_share() const {
  if (options_.stride == 1) return 0.0f;
  const GLuint listed = list_.count();
  return 1.0f - float(listed) / float(size_.x * size_.y);
}

size_t VirtualLightGather::bytes() const {
  size_t texels = 2 * size_t(size_.x) * size_t(size_.y);
  if (options_.stride > 1) texels += 2 * size_t(coarse_indirect_.size().x) * size_t(coarse_indirect_.size().y);
  return 16 * texels + list_.bytes();
}

}  // namespace volgi::screen
