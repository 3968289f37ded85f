#include "screen/gather/subsplats/light_cache.h"

#include <algorithm>

#include "shaders/screen/base/slots.shared.h"
#include "shaders/screen/gather/subsplats/slots.shared.h"
#include "shaders/screen/visibility/area_maps/slots.shared.h"
#include "shaders/shared/group_sizes.shared.h"

namespace volgi::screen {

namespace {

constexpr const char* SHADER = "screen/gather/subsplats/light_cache.comp.glsl";
constexpr size_t kBlockBytes = VIRTUAL_LIGHTS_PER_BLOCK * sizeof(shared::VirtualLight);

}  // namespace

LightCache::LightCache()
    : size_(sizeof(GLint)),
      count_(gl::Program::compute(SHADER, {"COUNT"})),
      copy_(gl::Program::compute(SHADER)),
      copy_clustered_(gl::Program::compute(SHADER, {"CLUSTERED"})) {}

int LightCache::blocks() const { return (most_ + VIRTUAL_LIGHTS_PER_BLOCK - 1) / VIRTUAL_LIGHTS_PER_BLOCK; }

void LightCache::bind_block(int block) const {
  glBindBufferRange(GL_UNIFORM_BUFFER, VIRTUAL_LIGHTS_BLOCK, cached_.id(), GLintptr(block) * GLintptr(kBlockBytes),
                    GLsizeiptr(kBlockBytes));
}

void LightCache::run(const VirtualLightListGl& lights, const VirtualAreaLights* clusters, gl::PassTimer& timer) {
  const auto scope = timer.scope(name);
  most_ = lights.count();
  gl::reserve(cached_, size_t(std::max(blocks(), 1)) * kBlockBytes);
  gl::reserve(starts_, size_t(std::max(most_, 1)) * sizeof(GLuint));
  cached_.clear();
  size_.clear();
  lights.buffer.bind_storage(VIRTUAL_LIGHTS_SLOT);
  const auto dispatch = [&](const gl::Program& program) {
    program.set("light_count", most_);
    program.use();
    gl::dispatch_linear(size_t(most_), LINEAR_GROUP);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  };
  if (clusters == nullptr) {
    starts_.bind_storage(CACHE_STARTS_SLOT);
    dispatch(count_);
    scan_.run(starts_, size_t(most_));
    lights.buffer.bind_storage(VIRTUAL_LIGHTS_SLOT);
    starts_.bind_storage(CACHE_STARTS_SLOT);
  } else {
    clusters->order().bind_storage(LIGHT_ORDER_SLOT);
    clusters->cluster_of().bind_storage(CLUSTER_OF_SLOT);
  }
  cached_.bind_storage(CACHED_LIGHTS_SLOT);
  size_.bind_storage(CACHE_SIZE_SLOT);
  dispatch(clusters == nullptr ? copy_ : copy_clustered_);
  glMemoryBarrier(GL_UNIFORM_BARRIER_BIT);
}

}  // namespace volgi::screen
