#include "propagation/bounces_gl.h"

#include <chrono>

#include "core/error.h"
#include "shaders/propagation/partial_sums.shared.h"
#include "shaders/propagation/slots.shared.h"
#include "shaders/shared/group_sizes.shared.h"

namespace volgi {

namespace {

constexpr size_t kPartialsBytes = PARTIAL_SUMS * sizeof(glm::vec4);

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

struct BouncesGl::Run {
  const VoxelGridGl& voxels;
  const SideFluxGl& flux;
  bool has_emission;  // or sky
  const BounceRules& rules;
  const Sky* sky;
};

BouncesGl::BouncesGl(std::unique_ptr<TransportGl> transport)
    : transport_(std::move(transport)),
      next_order_(gl::Program::compute("propagation/next_order.comp.glsl")),
      sum_sent_(gl::Program::compute("propagation/sum_sent.comp.glsl")),
      sum_partials_(gl::Program::compute("propagation/sum_partials.comp.glsl")),
      sum_(sizeof(glm::vec4)),
      partials_(kPartialsBytes),
      readback_(sizeof(glm::vec4), 2) {}

bool BouncesGl::needs_solver(const BounceRules& rules, bool linear) {
  return rules.continues() || rules.conjugate_gradients(linear);
}

void BouncesGl::make_room(const Run& run) {
  const bool amortised = run.rules.passes_per_run.has_value();
  bool continues = run.rules.continues();
  if (capacity_ != run.voxels.side_capacity) {
    capacity_ = run.voxels.side_capacity;
    continues = false;
    for (gl::Buffer* b : {&received_, &sent_, &received_direct_, &received_indirect_}) {
      *b = gl::Buffer(sizeof(glm::vec4) * size_t(capacity_));
    }
  }
  if (run.rules.bounces) gl::reserve(received_but_last_, received_indirect_.bytes());
  cut_ = false;
  if (!continues) received_indirect_.clear();
  // Amortised runs keep the arrival of emission, and what is in flight.
  if (!continues || !amortised || !run.has_emission) received_direct_.clear();
  if (!continues || !amortised) {
    received_.clear();
    in_flight_ = false;
    orders_begun_ = 0;
    if (solver_) solver_->drop_sums();
  }
  if (!needs_solver(run.rules, linear())) return;
  if (!solver_) solver_ = std::make_unique<BounceSolverGl>();
  solver_->make_room(capacity_);
  solver_->forget_other_sides(run.voxels, powers());
}

void BouncesGl::next_order(const VoxelGridGl& voxels, const gl::Buffer& total, const gl::Buffer* source,
                           bool already_reflected) {
  voxels.bind();
  received_.bind_storage(RECEIVED_SLOT);
  sent_.bind_storage(SENT_SLOT);
  total.bind_storage(TOTAL_SLOT);
  if (source != nullptr) source->bind_storage(SOURCE_SLOT);
  next_order_.use();
  next_order_.set("add_source", int(source != nullptr));
  next_order_.set("already_reflected", int(already_reflected));
  gl::dispatch_linear(capacity_, LINEAR_GROUP);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

void BouncesGl::request_sent(const VoxelGridGl& voxels) {
  voxels.bind();
  sent_.bind_storage(SENT_SLOT);
  partials_.bind_storage(PARTIALS_SLOT);
  sum_sent_.use();
  glDispatchCompute(PARTIAL_SUMS, 1, 1);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  sum_.bind_storage(SUM_SLOT);
  sum_partials_.use();
  glDispatchCompute(1, 1, 1);
  readback_.push(sum_);
}

glm::vec3 BouncesGl::pop_sent() {
  glm::vec4 sum;
  readback_.pop(&sum);
  return glm::vec3(sum);
}

BounceReport BouncesGl::run(const VoxelGridGl& voxels, const SideFluxGl& flux, bool has_emission,
                            const BounceRules& rules, gl::PassTimer& timer, const Sky* sky) {
  rules.check(linear());
  has_emission = has_emission || sky != nullptr;
  auto scope = timer.scope("propagation/propagate");
  const Run run{voxels, flux, has_emission, rules, sky};
  make_room(run);
  BounceReport report;
  if (rules.passes_per_run) {
    amortised(run, report);
  } else if (rules.conjugate_gradients(linear())) {
    solve_conjugate(run, report);
  } else if (rules.continues()) {
    renewals(run, report);
  } else {
    orders(run, report);
  }
  return report;
}

/// One order after another, from black: the series K e + K f K e + ...
void BouncesGl::orders(const Run& run, BounceReport& report) {
  const BounceRules& rules = run.rules;
  int orders = rules.bounces ? *rules.bounces + (run.has_emission ? 1 : 0) : BounceRules::kMaxOrders;
  if (rules.iterations && !transport_->iterative()) orders = std::min(orders, *rules.iterations);
  // received_ is zero here: this only makes the first order's sources into what sides send.
  next_order(run.voxels, received_indirect_, run.has_emission ? &run.flux.emitted() : &run.flux.punctual(), false);
  for (int order = 0; order < orders; ++order) {
    const bool arrival_of_emission = run.has_emission && order == 0;
    BounceRules order_rules = rules;
    if (arrival_of_emission && rules.together()) order_rules.iterations.reset();  // an order by itself
    const auto start = std::chrono::steady_clock::now();
    BounceReport carried;
    request_sent(run.voxels);
    transport_->stream_in(arrival_of_emission ? run.sky : nullptr);
    transport_->carry_sources(order <= (run.has_emission ? 1 : 0));
    transport_->carry(run.voxels, sent_, received_, order_rules, carried);
    transport_->carry_sources(false);
    const glm::vec3 sent = pop_sent();
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
    if (order == 0) announce_long_run(seconds_since(start), rules);
    const bool together = transport_->iterative() && order_rules.together();
    cut_ = rules.bounces && order + 1 == orders && !arrival_of_emission;
    if (cut_)
      glCopyNamedBufferSubData(received_indirect_.id(), received_but_last_.id(), 0, 0,
                               GLsizeiptr(received_indirect_.bytes()));
    next_order(run.voxels, arrival_of_emission ? received_direct_ : received_indirect_,
               arrival_of_emission ? &run.flux.punctual() : nullptr, together);
    if (together) break;
  }
}

/// Emission's first arrival, where all bounces follow at once. Its power is popped by the caller.
void BouncesGl::arrival_of_emission(const Run& run, BounceReport& report) {
  next_order(run.voxels, received_indirect_, &run.flux.emitted(), false);
  request_sent(run.voxels);
  transport_->stream_in(run.sky);
  transport_->carry_sources(true);
  transport_->carry(run.voxels, sent_, received_, run.rules, report);
  transport_->carry_sources(false);
  transport_->stream_in(nullptr);
  next_order(run.voxels, received_direct_, nullptr, false);
  report.orders += 1;
}

/// P <- K(e + fP) until that changes nothing any more.
void BouncesGl::renewals(const Run& run, BounceReport& report) {
  if (run.has_emission) arrival_of_emission(run, report);
  solver_->set_source(run.voxels, powers(), run.flux.punctual());
  solver_->send_all(run.voxels, powers(), true);
  const glm::vec3 arrival = run.has_emission ? pop_sent() : glm::vec3(0.0f);
  const glm::vec3 arrival_left = report.left;
  glm::vec3 order_left(0.0f);
  const auto start = std::chrono::steady_clock::now();
  for (int order = 0; order < BounceRules::kMaxOrders; ++order) {
    BounceReport carried;
    transport_->carry(run.voxels, sent_, received_, run.rules, carried);
    report.passes += carried.passes;
    if (order == 1) announce_long_run(seconds_since(start), run.rules);
    if (order > 0) {
      const BounceSolverGl::Sums sums = solver_->pop_sums();
      report.sent = arrival + sums.total_sent;
      report.left = arrival_left + order_left + sums.next_sent;
      report.converged = run.rules.orders_ended(sums.next_sent, report.sent);
      if (report.converged) return;
    }
    order_left = carried.left;
    report.orders += 1;
    solver_->publish(run.voxels, powers());
    solver_->push_sums();
  }
  solver_->drop_sums();
}

void BouncesGl::solve_conjugate(const Run& run, BounceReport& report) {
  const int limit =
      std::min(run.rules.iterations.value_or(BounceRules::kMaxConjugatePasses), BounceRules::kMaxConjugatePasses);
  report.conjugate_gradients = true;
  if (run.has_emission) arrival_of_emission(run, report);
  solver_->set_source(run.voxels, powers(), run.flux.punctual());
  solver_->send_all(run.voxels, powers(), true);
  transport_->carry_sources(true);
  transport_->carry(run.voxels, sent_, received_, run.rules, report);
  transport_->carry_sources(false);
  report.orders += 1;
  solver_->start(run.voxels, powers());
  solver_->push_sums();
  const glm::vec3 arrival = run.has_emission ? pop_sent() : glm::vec3(0.0f);
  for (int pass = 1;; ++pass) {
    if (pass < limit) transport_->carry(run.voxels, sent_, received_, run.rules, report);
    const BounceSolverGl::Sums sums = solver_->pop_sums();
    report.sent = arrival + sums.total_sent;
    report.left = sums.next_sent;
    report.converged = run.rules.orders_ended(sums.next_sent, report.sent);
    if (report.converged || pass == limit) break;
    report.orders += 1;
    solver_->step(run.voxels, powers());
    solver_->push_sums();
  }
  solver_->end(run.voxels, powers());
}

void BouncesGl::begin_order(const Run& run) {
  arrival_in_flight_ = run.has_emission && orders_begun_ % run.rules.arrival_cycle(transport_->iterative()) == 0;
  ++orders_begun_;
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  received_.clear();
  if (arrival_in_flight_) {
    next_order(run.voxels, received_direct_, &run.flux.emitted(), false);  // adds nothing to what has arrived before
  } else {
    solver_->set_source(run.voxels, powers(), run.flux.punctual());
    solver_->send_all(run.voxels, powers(), false);
  }
  transport_->stream_in(arrival_in_flight_ ? run.sky : nullptr);
  if (ResumableGl* resumable = transport_->resumable()) resumable->begin_order(run.voxels, sent_);
  in_flight_ = true;
}

bool BouncesGl::advance_order(const Run& run, int max_passes, BounceReport& report) {
  if (ResumableGl* resumable = transport_->resumable()) {
    return resumable->advance_order(run.voxels, received_, max_passes, run.rules, report);
  }
  transport_->carry(run.voxels, sent_, received_, run.rules, report);
  return true;
}

/// As many passes as there may be; an order that is not at its end then goes on in the next run.
void BouncesGl::amortised(const Run& run, BounceReport& report) {
  if (transport_->iterative() && transport_->resumable() == nullptr) {
    throw Error(ExitCode::usage,
                "amortised bounces: this scheme cannot interrupt an order on the GPU; use --scheme ordinates or "
                "--backend cpu");
  }
  const int limit = *run.rules.passes_per_run;
  bool published = false;
  while (report.passes < limit) {
    if (!in_flight_) begin_order(run);
    BounceReport carried;
    const bool ended = advance_order(run, limit - report.passes, carried);
    report.passes += std::max(carried.passes, 1);
    if (!ended) continue;
    in_flight_ = false;
    report.orders += 1;
    report.left = carried.left;
    if (arrival_in_flight_) {
      glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
      received_direct_.clear();
      next_order(run.voxels, received_direct_, nullptr, false);
    } else {
      solver_->publish(run.voxels, powers());
      published = true;
    }
  }
  if (published) solver_->push_sums();
  if (solver_->pending_sums() > 1) {  // what the answer before this one has come to
    const BounceSolverGl::Sums sums = solver_->pop_sums();
    report.sent = sums.total_sent;
    report.left += sums.next_sent;
    report.converged = run.rules.orders_ended(sums.next_sent, sums.total_sent);
  }
}

gl::Buffer BouncesGl::sent(const VoxelGridGl& voxels, const SideFluxGl& flux) const {
  const gl::Program kernel = gl::Program::compute("propagation/total_sent_power.comp.glsl");
  gl::Buffer all(sizeof(glm::vec4) * size_t(capacity_));
  all.clear();
  voxels.bind();
  received_direct_.bind_storage(TOTAL_DIRECT_SLOT);
  received_indirect_.bind_storage(TOTAL_INDIRECT_SLOT);
  flux.emitted().bind_storage(EMITTED_FLUX_SLOT);
  flux.punctual().bind_storage(PUNCTUAL_FLUX_SLOT);
  all.bind_storage(TOTAL_SENT_SLOT);
  kernel.use();
  gl::dispatch_linear(capacity_, LINEAR_GROUP);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  return all;
}

size_t BouncesGl::bytes_for(std::uint32_t side_capacity, const BounceRules& rules, bool linear) {
  const size_t solver = needs_solver(rules, linear) ? BounceSolverGl::bytes_for(side_capacity) : 0;
  const size_t powers = rules.bounces ? 5 : 4;
  return powers * sizeof(glm::vec4) * size_t(side_capacity) + sizeof(glm::vec4) + kPartialsBytes + solver;
}

size_t BouncesGl::bytes() const {
  return transport_->bytes() + received_.bytes() + sent_.bytes() + received_direct_.bytes() +
         received_indirect_.bytes() + received_but_last_.bytes() + sum_.bytes() + partials_.bytes() +
         (solver_ ? solver_->bytes() : 0);
}

}  // namespace volgi
