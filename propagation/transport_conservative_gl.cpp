#include "propagation/transport_conservative_gl.h"

#include <algorithm>

namespace volgi {

namespace {

constexpr glm::ivec3 kLocal{8, 8, 4};  // propagate.comp.glsl, emit.comp.glsl
constexpr int kBatch = 8;  // passes between two looks at the power in flight: a look costs a third of a pass

// A pulse that has not ended after 64 crossings of the grid never will (a closed box without losses).
int most_passes(const Grid& g) { return 64 * (g.cells.x + g.cells.y + g.cells.z); }

}  // namespace

ConservativeTransportGl::ConservativeTransportGl(const Grid& grid)
    : emit_(gl::Program::compute("propagation/emit.comp.glsl")),
      propagate_(gl::Program::compute("propagation/propagate.comp.glsl")),
      sum_in_flight_(gl::Program::compute("propagation/sum_in_flight.comp.glsl")),
      sum_partials_(gl::Program::compute("propagation/sum_partials.comp.glsl")),
      partials_(64 * sizeof(glm::vec4)),
      sum_(sizeof(glm::vec4)),
      readback_(sizeof(glm::vec4), 2),
      grid_(grid) {
  for (gl::Texture& t : lobes_) t = gl::Texture::make_3d(GL_RGBA32F, {grid.cells.x, grid.cells.y, 3 * grid.cells.z});
}

void ConservativeTransportGl::carry(const VoxelGridGl& voxels, const gl::Buffer& sent, const gl::Buffer& received,
                                    const BounceRules& rules, BounceReport& report) {
  const int most = rules.iterations ? *rules.iterations : most_passes(grid_);
  emit(voxels, sent);
  request_in_flight(voxels);
  glm::vec3 start(0.0f), now(0.0f);
  bool ended = false;
  for (int passes = 0; passes < most && !ended;) {
    const int batch = std::min(kBatch, most - passes);
    advance(voxels, received, batch, rules.together());
    request_in_flight(voxels);
    now = pop_in_flight();  // as it was before this batch
    if (passes == 0) start = now;
    ended = !rules.iterations && rules.pulse_ended(now, start);
    passes += batch;
    report.passes += batch;
  }
  report.left += pop_in_flight();
}

void ConservativeTransportGl::emit(const VoxelGridGl& voxels, const gl::Buffer& sent) {
  voxels.bind();
  sent.bind_storage(7);
  lobes_[current_].bind_image(0, GL_WRITE_ONLY);
  emit_.use();
  gl::dispatch(grid_.cells, kLocal);
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
}

void ConservativeTransportGl::advance(const VoxelGridGl& voxels, const gl::Buffer& received, int passes,
                                      bool reflect_hits) {
  voxels.bind();
  received.bind_storage(6);
  propagate_.use();
  propagate_.set("reflect_hits", int(reflect_hits));
  for (int pass = 0; pass < passes; ++pass) {
    lobes_[current_].bind(0);
    lobes_[1 - current_].bind_image(0, GL_WRITE_ONLY);
    gl::dispatch(grid_.cells, kLocal);
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);
    current_ = 1 - current_;
  }
}

void ConservativeTransportGl::request_in_flight(const VoxelGridGl& voxels) {
  voxels.bind();
  lobes_[current_].bind(0);
  partials_.bind_storage(10);
  sum_in_flight_.use();
  glDispatchCompute(64, 1, 1);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  sum_.bind_storage(11);
  sum_partials_.use();
  glDispatchCompute(1, 1, 1);
  readback_.push(sum_);
}

glm::vec3 ConservativeTransportGl::pop_in_flight() {
  glm::vec4 sum;
  readback_.pop(&sum);
  return glm::vec3(sum);
}

glm::vec3 ConservativeTransportGl::in_flight(const VoxelGridGl& voxels) {
  request_in_flight(voxels);
  return pop_in_flight();
}

size_t ConservativeTransportGl::bytes() const { return partials_.bytes() + 2 * 48 * cell_count(grid_); }

}  // namespace volgi
