#include "propagation/transport_conservative_gl.h"

#include <fmt/format.h>

#include <algorithm>

#include "shaders/propagation/partial_sums.shared.h"
#include "shaders/propagation/slots.shared.h"
#include "shaders/shared/group_sizes.shared.h"

namespace volgi {

namespace {

constexpr glm::ivec3 kLocal{CELL_GROUP_X, CELL_GROUP_Y, CELL_GROUP_Z};
constexpr int kBatch = 8;  // passes between two looks at the power in flight: a look costs a third of a pass

constexpr size_t kPartialsBytes = PARTIAL_SUMS * sizeof(glm::vec4);

/// A state of lobes: the three bands' stacked in z (lobes.glsl).
glm::ivec3 lobe_texels(const Grid& grid, int order) {
  return {grid.cells.x, grid.cells.y, (order == 1 ? 3 : 7) * grid.cells.z};
}

// A pulse that has not ended after 64 crossings of the grid never will (a closed box without losses).
int max_passes(const Grid& g) { return 64 * (g.cells.x + g.cells.y + g.cells.z); }

}  // namespace

ConservativeTransportGl::ConservativeTransportGl(const Grid& grid, int sh_order)
    : order_(sh_order),
      emit_(compile("emit")),
      propagate_(compile("propagate")),
      sum_lobes_(compile("sum_in_flight")),
      sum_partials_(gl::Program::compute("propagation/sum_partials.comp.glsl")),
      partials_(kPartialsBytes),
      sum_(sizeof(glm::vec4)),
      readback_(sizeof(glm::vec4), 2),
      grid_(grid) {
  make_lobes();
}

gl::Program ConservativeTransportGl::compile(const char* shader) const {
  return gl::Program::compute(fmt::format("propagation/{}.comp.glsl", shader),
                              {fmt::format("ORDER {}", order_), "PULSE 0"});
}

void ConservativeTransportGl::carry(const VoxelGridGl& voxels, const gl::Buffer& sent, const gl::Buffer& received,
                                    const BounceRules& rules, BounceReport& report) {
  begin_order(voxels, sent);
  while (!advance_order(voxels, received, max_passes(grid_), rules, report)) {
  }
}

void ConservativeTransportGl::begin_order(const VoxelGridGl& voxels, const gl::Buffer& sent) {
  readback_.drop_all();  // of an order that was not carried to its end
  emit(voxels, sent);
  request_in_flight(voxels);
  passes_ = 0;
}

bool ConservativeTransportGl::advance_order(const VoxelGridGl& voxels, const gl::Buffer& received, int max_passes_now,
                                            const BounceRules& rules, BounceReport& report) {
  const int limit = rules.iterations ? *rules.iterations : max_passes(grid_);
  bool ended = passes_ >= limit;
  for (int done = 0; done < max_passes_now && !ended;) {
    const int batch = std::min({kBatch, limit - passes_, max_passes_now - done});
    advance(voxels, received, batch, rules.together());
    request_in_flight(voxels);
    const glm::vec3 now = pop_in_flight();  // as it was before this batch
    if (passes_ == 0) start_ = now;
    passes_ += batch;
    done += batch;
    report.passes += batch;
    ended = passes_ >= limit || (!rules.iterations && rules.pulse_ended(now, start_));
  }
  if (ended) report.left += pop_in_flight();
  return ended;
}

void ConservativeTransportGl::emit(const VoxelGridGl& voxels, const gl::Buffer& sent) {
  voxels.bind();
  sent.bind_storage(SENT_SLOT);
  lobes_[current_].bind_image(NEXT_LOBES_IMAGE, GL_WRITE_ONLY);
  emit_.use();
  gl::dispatch(grid_.cells, kLocal);
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
}

void ConservativeTransportGl::advance(const VoxelGridGl& voxels, const gl::Buffer& received, int passes,
                                      bool reflect_hits) {
  voxels.bind();
  received.bind_storage(RECEIVED_SLOT);
  propagate_.use();
  propagate_.set("reflect_hits", int(reflect_hits));
  for (int pass = 0; pass < passes; ++pass) {
    lobes_[current_].bind(LOBES_UNIT);
    lobes_[1 - current_].bind_image(NEXT_LOBES_IMAGE, GL_WRITE_ONLY);
    gl::dispatch(grid_.cells, kLocal);
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);
    current_ = 1 - current_;
  }
}

void ConservativeTransportGl::sum_in_flight(const VoxelGridGl& voxels) {
  voxels.bind();
  lobes_[current_].bind(LOBES_UNIT);
  partials_.bind_storage(PARTIALS_SLOT);
  sum_lobes_.use();
  glDispatchCompute(PARTIAL_SUMS, 1, 1);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  sum_.bind_storage(SUM_SLOT);
  sum_partials_.use();
  glDispatchCompute(1, 1, 1);
}

void ConservativeTransportGl::request_in_flight(const VoxelGridGl& voxels) {
  sum_in_flight(voxels);
  readback_.push(sum_);
}

glm::vec3 ConservativeTransportGl::pop_in_flight() {
  glm::vec4 sum;
  readback_.pop(&sum);
  return glm::vec3(sum);
}

glm::vec3 ConservativeTransportGl::in_flight(const VoxelGridGl& voxels) {
  sum_in_flight(voxels);
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  return glm::vec3(sum_.download<glm::vec4>(1)[0]);
}

void ConservativeTransportGl::make_lobes() {
  for (gl::Texture& t : lobes_) {
    t = gl::Texture::make_3d(GL_RGBA32F, lobe_texels(grid_, order_));
  }
}

RadianceVolumeGl ConservativeTransportGl::radiance(const VoxelGridGl& voxels, const gl::Buffer& sent) {
  if (!add_radiance_) add_radiance_ = compile("add_radiance");
  RadianceVolumeGl result(grid_, order_ == 1 ? 4 : 9);
  const gl::Buffer ignored(sent.bytes());
  const BounceRules rules;
  gl::Texture under_way[2] = {std::move(lobes_[0]), std::move(lobes_[1])};  // an order may have stopped between passes
  make_lobes();
  const int current_under_way = current_;
  emit(voxels, sent);
  const glm::vec3 start = in_flight(voxels);
  for (int passes = 0; passes < max_passes(grid_); ++passes) {
    voxels.bind();
    lobes_[current_].bind(LOBES_UNIT);
    result.sh.bind_image(LOBES_RADIANCE_IMAGE, GL_READ_WRITE);
    add_radiance_->use();
    add_radiance_->set("odd_sign", 1.0f);
    add_radiance_->set("stored_rescaled", 1);
    gl::dispatch(grid_.cells, kLocal);
    glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT);
    if (passes % kBatch == 0 && rules.pulse_ended(in_flight(voxels), start)) break;
    advance(voxels, ignored, 1, false);
  }
  for (int i = 0; i < 2; ++i) lobes_[i] = std::move(under_way[i]);
  current_ = current_under_way;
  return result;
}

size_t ConservativeTransportGl::bytes_for(const Grid& grid, int sh_order) {
  const glm::ivec3 texels = lobe_texels(grid, sh_order);
  return kPartialsBytes + 2 * sizeof(glm::vec4) * size_t(texels.x) * size_t(texels.y) * size_t(texels.z);
}

}  // namespace volgi
