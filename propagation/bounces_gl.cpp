#include "propagation/bounces_gl.h"

#include <chrono>
#include <string>

#include "core/log.h"

namespace volgi {

namespace {

constexpr int kMostOrders = 5000;  // 0.2 % at the largest albedo that counts, 0.99, needs 1,300

void announce_long_run(double seconds_an_order, const BounceRules& rules) {
  double estimate = seconds_an_order * rules.expected_orders();
  if (rules.together() || estimate < 60.0) return;
  warn_once("light propagation is going to take up to " + std::to_string(int(estimate)) + " s (largest albedo " +
            std::to_string(rules.largest_albedo).substr(0, 4) + "); --bounces or a smaller --grid shorten it");
}

}  // namespace

BouncesGl::BouncesGl(std::unique_ptr<TransportGl> transport)
    : transport_(std::move(transport)),
      next_order_(gl::Program::compute("propagation/next_order.comp.glsl")),
      sum_sent_(gl::Program::compute("propagation/sum_sent.comp.glsl")),
      sum_partials_(gl::Program::compute("propagation/sum_partials.comp.glsl")),
      sum_(sizeof(glm::vec4)),
      partials_(64 * sizeof(glm::vec4)),
      readback_(sizeof(glm::vec4), 2) {}

void BouncesGl::make_room(const VoxelGridGl& voxels) {
  if (capacity_ != voxels.side_capacity) {
    capacity_ = voxels.side_capacity;
    for (gl::Buffer* b : {&received_, &sent_, &received_direct_, &received_indirect_}) {
      *b = gl::Buffer(sizeof(glm::vec4) * size_t(capacity_));
    }
  }
  for (gl::Buffer* b : {&received_, &received_direct_, &received_indirect_}) b->clear();
}

void BouncesGl::next_order(const VoxelGridGl& voxels, const gl::Buffer& total, const gl::Buffer* source,
                           bool already_reflected) {
  voxels.bind();
  received_.bind_storage(6);
  sent_.bind_storage(7);
  total.bind_storage(8);
  if (source != nullptr) source->bind_storage(9);
  next_order_.use();
  next_order_.set("add_source", int(source != nullptr));
  next_order_.set("already_reflected", int(already_reflected));
  gl::dispatch({int(capacity_), 1, 1}, {64, 1, 1});
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

void BouncesGl::request_sent(const VoxelGridGl& voxels) {
  voxels.bind();
  sent_.bind_storage(7);
  partials_.bind_storage(10);
  sum_sent_.use();
  glDispatchCompute(64, 1, 1);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  sum_.bind_storage(11);
  sum_partials_.use();
  glDispatchCompute(1, 1, 1);
  readback_.push(sum_);
}

BounceReport BouncesGl::run(const VoxelGridGl& voxels, const SideFluxGl& flux, bool has_emission,
                            const BounceRules& rules, gl::PassTimer& timer) {
  auto scope = timer.scope("propagation/propagate");
  make_room(voxels);
  BounceReport report;
  int orders = rules.bounces ? *rules.bounces + (has_emission ? 1 : 0) : kMostOrders;
  if (rules.iterations && !transport_->iterative()) orders = std::min(orders, *rules.iterations);
  // received_ is zero here: this only makes the first order's sources into what sides send.
  next_order(voxels, received_indirect_, has_emission ? &flux.emitted() : &flux.punctual(), false);
  for (int order = 0; order < orders; ++order) {
    const bool arrival_of_emission = has_emission && order == 0;
    BounceRules order_rules = rules;
    if (arrival_of_emission && rules.together()) order_rules.iterations.reset();  // an order by itself
    const auto start = std::chrono::steady_clock::now();
    BounceReport carried;
    request_sent(voxels);
    transport_->carry(voxels, sent_, received_, order_rules, carried);
    glm::vec4 sum;
    readback_.pop(&sum);
    const glm::vec3 sent(sum);
    report.passes += carried.passes;
    const bool dark = sent == glm::vec3(0.0f) && !arrival_of_emission;
    if (dark || (!rules.bounces && order > 0 && rules.orders_ended(sent, report.sent))) {
      report.left += sent;
      report.converged = true;
      break;
    }
    report.orders += 1;
    report.sent += sent;
    report.left += carried.left;
    if (order == 0)
      announce_long_run(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), rules);
    const bool together = transport_->iterative() && order_rules.together();
    next_order(voxels, arrival_of_emission ? received_direct_ : received_indirect_,
               arrival_of_emission ? &flux.punctual() : nullptr, together);
    if (together) break;
  }
  return report;
}

size_t BouncesGl::bytes() const {
  return transport_->bytes() + received_.bytes() + sent_.bytes() + received_direct_.bytes() +
         received_indirect_.bytes() + sum_.bytes() + partials_.bytes();
}

}  // namespace volgi
