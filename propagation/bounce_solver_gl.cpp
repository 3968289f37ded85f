#include "propagation/bounce_solver_gl.h"

#include <array>

#include "propagation/bounce_rules.h"
#include "shaders/propagation/slots.shared.h"
#include "shaders/shared/bounce_state.shared.h"

namespace volgi {

using shared::BounceState;

static_assert(float(BounceRules::kMinLoss) == BOUNCE_MIN_LOSS);

namespace {

constexpr size_t kPartialsBytes = 3 * BOUNCE_PARTIALS * sizeof(glm::vec4);

}  // namespace

BounceSolverGl::BounceSolverGl()
    : source_kernel_(gl::Program::compute("propagation/solver_source.comp.glsl")),
      send_kernel_(gl::Program::compute("propagation/solver_send.comp.glsl")),
      publish_kernel_(gl::Program::compute("propagation/solver_publish.comp.glsl")),
      reset_kernel_(gl::Program::compute("propagation/solver_reset.comp.glsl")),
      start_kernel_(gl::Program::compute("propagation/conjugate_start.comp.glsl")),
      curvature_kernel_(gl::Program::compute("propagation/conjugate_curvature.comp.glsl")),
      step_kernel_(gl::Program::compute("propagation/conjugate_step.comp.glsl")),
      direction_kernel_(gl::Program::compute("propagation/conjugate_direction.comp.glsl")),
      end_kernel_(gl::Program::compute("propagation/conjugate_end.comp.glsl")),
      scalars_kernel_(gl::Program::compute("propagation/solver_scalars.comp.glsl")),
      partials_(kPartialsBytes),
      state_(sizeof(BounceState)),
      last_count_(sizeof(std::uint32_t)),
      readback_(2 * sizeof(glm::vec4), 3) {
  state_.clear();
  last_count_.clear();
}

void BounceSolverGl::make_room(std::uint32_t side_capacity) {
  if (capacity_ == side_capacity) return;
  capacity_ = side_capacity;
  source_ = gl::Buffer(sizeof(glm::vec4) * size_t(capacity_));
  residual_ = gl::Buffer(sizeof(glm::vec4) * size_t(capacity_));
  state_.clear();
}

size_t BounceSolverGl::bytes_for(std::uint32_t side_capacity) {
  return 2 * sizeof(glm::vec4) * size_t(side_capacity) + kPartialsBytes + sizeof(BounceState);
}

void BounceSolverGl::run(const gl::Program& kernel, const VoxelGridGl& voxels, const Powers& powers) {
  voxels.bind();
  powers.received.bind_storage(RECEIVED_SLOT);
  powers.sent.bind_storage(SENT_SLOT);
  powers.total.bind_storage(TOTAL_SLOT);
  source_.bind_storage(SOURCE_SLOT);
  partials_.bind_storage(PARTIALS_SLOT);
  state_.bind_storage(STATE_SLOT);
  residual_.bind_storage(RESIDUAL_SLOT);
  kernel.use();
  glDispatchCompute(BOUNCE_PARTIALS, 1, 1);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

void BounceSolverGl::add_up(int sums) {
  partials_.bind_storage(PARTIALS_SLOT);
  state_.bind_storage(STATE_SLOT);
  scalars_kernel_.use();
  scalars_kernel_.set("sums", sums);
  glDispatchCompute(1, 1, 1);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

void BounceSolverGl::forget_other_sides(const VoxelGridGl& voxels, const Powers& powers) {
  powers.direct.bind_storage(FIRST_ARRIVAL_SLOT);
  last_count_.bind_storage(LAST_COUNT_SLOT);
  run(reset_kernel_, voxels, powers);
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  glCopyNamedBufferSubData(voxels.side_count.id(), last_count_.id(), 0, 0, sizeof(std::uint32_t));
}

void BounceSolverGl::set_source(const VoxelGridGl& voxels, const Powers& powers, const gl::Buffer& punctual) {
  powers.direct.bind_storage(FIRST_ARRIVAL_SLOT);
  punctual.bind_storage(SOURCE_PUNCTUAL_SLOT);
  run(source_kernel_, voxels, powers);
  add_up(BOUNCE_SUMS_SOURCE);
}

void BounceSolverGl::send_all(const VoxelGridGl& voxels, const Powers& powers, bool scaled) {
  send_kernel_.set("scaled", int(scaled));
  run(send_kernel_, voxels, powers);
}

void BounceSolverGl::publish(const VoxelGridGl& voxels, const Powers& powers) {
  run(publish_kernel_, voxels, powers);
  add_up(BOUNCE_SUMS_CHANGE);
}

void BounceSolverGl::start(const VoxelGridGl& voxels, const Powers& powers) {
  run(start_kernel_, voxels, powers);
  add_up(BOUNCE_SUMS_RESIDUAL);
}

void BounceSolverGl::step(const VoxelGridGl& voxels, const Powers& powers) {
  run(curvature_kernel_, voxels, powers);
  add_up(BOUNCE_SUMS_CURVATURE);
  run(step_kernel_, voxels, powers);
  add_up(BOUNCE_SUMS_RESIDUAL);
  run(direction_kernel_, voxels, powers);
}

void BounceSolverGl::end(const VoxelGridGl& voxels, const Powers& powers) { run(end_kernel_, voxels, powers); }

void BounceSolverGl::push_sums() { readback_.push(state_, offsetof(BounceState, next_sent)); }

BounceSolverGl::Sums BounceSolverGl::pop_sums() {
  std::array<glm::vec4, 2> sums;
  readback_.pop(sums.data());
  return {glm::vec3(sums[0]), glm::vec3(sums[1])};
}

}  // namespace volgi
