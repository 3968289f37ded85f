#include "screen/visibility/negative/negative_lights.h"

#include <cassert>
#include <cmath>

#include "core/sample_sequence.h"
#include "shaders/screen/base/slots.shared.h"
#include "shaders/screen/visibility/negative/negative_candidates.shared.h"
#include "shaders/screen/visibility/negative/slots.shared.h"
#include "shaders/shared/group_sizes.shared.h"

namespace volgi::screen {

namespace {

using Method = NegativeLightOptions::Method;

/// Turns that light may have to take on its way into the last corner: three axes a round. What it does not find counts
/// as closed, and loses negative lights there.
constexpr int kSpreadRounds = 6;

/// What shaders/screen/visibility/negative/passed_light.glsl needs.
void set_view(const gl::Program& program, const Camera& camera, glm::ivec2 size) {
  const bool perspective = camera.kind == Camera::Kind::perspective;
  const float half_height = perspective ? std::tan(0.5f * camera.yfov_rad) : camera.ymag;
  const float pixel = 2.0f * half_height / float(size.y);
  program.set("viewer", perspective ? camera.world_from_camera[3] : camera.world_from_camera[2]);
  program.set("view_axis", glm::normalize(glm::vec3(camera.world_from_camera[2])));
  program.set("pixel_m2", pixel * pixel);
}

}  // namespace

NegativeLights::NegativeLights(const NegativeLightOptions& options)
    : options_(options), lights_(MAX_NEGATIVE_LIGHTS * sizeof(shared::NegativeLight)) {
  assert(options.count >= 1 && options.count <= MAX_NEGATIVE_LIGHTS);
  std::vector<std::string> defines;
  if (options_.method != Method::cochran2007) defines.emplace_back("PASSED_FLUX");
  if (options_.method == Method::sides) defines.emplace_back("SIDES");
  place_ = gl::Program::compute("screen/visibility/negative/negative_lights.comp.glsl", defines);
  if (options_.method == Method::cochran2007) return;
  weigh_ = gl::Program::compute("screen/visibility/negative/negative_weights.comp.glsl", defines);
  sum_ = std::make_unique<SumInOrder>("screen/visibility/negative/negative_sum.comp.glsl", defines);
  if (options_.method != Method::sides) return;
  seed_ = gl::Program::compute("screen/visibility/negative/open_cells_seed.comp.glsl");
  spread_ = std::make_unique<CellSpreadGl>();
  count_ = gl::Program::compute("screen/visibility/negative/sides_by_block_count.comp.glsl");
  scan_ = std::make_unique<gl::Scan>();
  list_ = gl::Program::compute("screen/visibility/negative/sides_by_block_list.comp.glsl");
}

void NegativeLights::run(const GBuffer& gbuffer, const Camera& camera, const VirtualLightListGl& lights,
                         const VoxelGridGl* voxels, gl::PassTimer& timer, int sample) {
  assert((options_.method == Method::sides) == (voxels != nullptr));
  const auto scope = timer.scope(name);
  gbuffer.bind();
  if (voxels != nullptr) {
    voxels->bind();
    order_sides(*voxels);
  }
  lights.buffer.bind_storage(VIRTUAL_LIGHTS_SLOT);
  lights_.bind_storage(PLACED_LIGHTS_SLOT);
  if (voxels != nullptr) find_open_cells(*voxels, lights.reflected);
  for (const gl::Program* program : {&weigh_, &place_}) {
    if (program->id() == 0) continue;
    program->set("light_count", lights.reflected);
    set_view(*program, camera, gbuffer.size());
  }
  if (options_.method != Method::cochran2007) choose(voxels);
  place_.use();
  place_.set("negative_count", options_.count);
  if (options_.method == Method::cochran2007) {
    place_.set("first_point", GLuint(sample) * GLuint(options_.count));
  } else {
    const double in_step = 0.5 + sample_shift(SampleChoice::negative_lights, std::uint64_t(sample));
    place_.set("in_step", float(glm::fract(in_step)));
  }
  gl::dispatch({options_.count, 1, 1}, {1, 1, 1});
  glMemoryBarrier(GL_UNIFORM_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);
}

void NegativeLights::order_sides(const VoxelGridGl& voxels) {
  const glm::ivec3 edge = (voxels.grid.cells + BLOCK_EDGE - 1) / BLOCK_EDGE;
  const size_t blocks = size_t(edge.x) * size_t(edge.y) * size_t(edge.z);
  gl::reserve(sides_by_block_, size_t(std::max(voxels.side_capacity, 1u)) * sizeof(GLuint));
  gl::reserve(block_starts_, blocks * sizeof(GLuint));
  const auto run = [&](const gl::Program& program) {
    sides_by_block_.bind_storage(SIDES_BY_BLOCK_SLOT);
    block_starts_.bind_storage(BLOCK_STARTS_SLOT);
    program.use();
    gl::dispatch_linear(blocks, 1);  // a group to each
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  };
  run(count_);
  scan_->run(block_starts_, blocks);
  run(list_);
}

void NegativeLights::find_open_cells(const VoxelGridGl& voxels, int light_count) {
  const size_t bytes = cell_count(voxels.grid) * sizeof(GLuint);
  if (open_cells_.bytes() != bytes) open_cells_ = gl::Buffer(bytes);
  open_cells_.clear();
  open_cells_.bind_storage(OPEN_CELLS_SLOT);
  seed_.use();
  seed_.set("light_count", light_count);
  gl::dispatch_linear(size_t(light_count), LINEAR_GROUP);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  spread_->run(voxels, open_cells_, kSpreadRounds);
}

void NegativeLights::choose(const VoxelGridGl* voxels) {
  const size_t candidates = voxels != nullptr ? voxels->side_capacity : size_t(CANDIDATES_X) * CANDIDATES_Y;
  gl::reserve(weights_, std::max(candidates, size_t(1)) * sizeof(float));
  weights_.bind_storage(PASSED_FLUX_SLOT);
  weigh_.use();
  gl::dispatch_linear(candidates, LINEAR_GROUP);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  sum_->run();
}

std::vector<shared::NegativeLight> NegativeLights::download() const {
  return lights_.download<shared::NegativeLight>(size_t(options_.count));
}

}  // namespace volgi::screen
