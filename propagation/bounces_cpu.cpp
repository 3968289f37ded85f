#include "propagation/bounces_cpu.h"

#include <algorithm>
#include <cassert>
#include <chrono>

namespace volgi {

using shared::Side;

namespace {

glm::vec3 sent_power(const Side& side, glm::vec4 flux) {
  return shared::side_sent_power(glm::vec3(flux), side.albedo, side.area_m2, side.face_m2);
}

}  // namespace

void BouncesCpu::make_room(const Run& run) {
  const size_t count = run.sides.count();
  sums_.set(run.sides, ranks_);
  const bool continues = run.rules.continues() && received_indirect_.size() == count;
  if (!continues) {
    received_indirect_.assign(count, glm::vec4(0.0f));
    source_power_ = glm::dvec3(0.0);
  }
  // Amortised runs keep the arrival of emission, and what is in flight.
  if (!continues || !run.rules.passes_per_run || !run.has_emission) received_direct_.assign(count, glm::vec4(0.0f));
  if (!continues || !run.rules.passes_per_run) {
    in_flight_ = false;
    orders_begun_ = 0;
    received_.assign(count, glm::vec4(0.0f));
  }
  source_.resize(count);
  sent_.resize(count);
  response_.resize(count);
  for_each_side(count, [&](size_t i) {
    const Side& side = run.sides[i];
    const bool receives = side.coverage > 0.0f && side.face_m2 > 0.0f;
    const glm::vec3 f =
        receives ? shared::side_returned_fraction(side.albedo, side.area_m2, side.face_m2) : glm::vec3(0);
    response_[i] = glm::vec4(f, std::min(side.coverage, 1.0f) * run.sides.relative_face(i));
  });
}

BounceReport BouncesCpu::run(const VolumeSides& sides, const SideFlux& flux, bool has_emission,
                             const BounceRules& rules, const Sky* sky) {
  rules.check(transport_->linear());
  has_emission = has_emission || sky != nullptr;
  const Run run{sides, flux, has_emission, rules, sky};
  make_room(run);
  BounceReport report;
  if (rules.passes_per_run) {
    amortised(run, report);
    return report;
  }
  const int limit = rules.bounces ? *rules.bounces + (has_emission ? 1 : 0) : BounceRules::kMaxOrders;
  resumed_.reset();
  cut_ = false;
  assert(checkpoint_ == nullptr || sides.levels() == 1);
  const bool resumed = checkpoint_ != nullptr && !rules.continues() && go_on(run, report);
  if (has_emission && limit > 0 && !resumed) arrival_of_emission(run, report);
  const glm::vec4 share = set_source(run);
  if (rules.conjugate_gradients(transport_->linear())) {
    solve_conjugate(run, share, report);
  } else if (rules.continues()) {
    renewals(run, share, report);
  } else {
    orders(run, limit, report);
  }
  return report;
}

/// Takes what the checkpoint has. @return false: nothing.
bool BouncesCpu::go_on(const Run& run, BounceReport& report) {
  state_of_ = {};
  std::array<std::int64_t, 1> sides{std::int64_t(run.sides.count())};
  if (ranks_ != nullptr) ranks_->add(sides);
  state_of_.sides = sides[0];
  state_of_.cells = run.sides.level(0).grid().cells;
  state_of_.conjugate_gradients = run.rules.conjugate_gradients(transport_->linear());
  send_emission(run);
  state_of_.emission = total(sent_);
  state_of_.punctual = sums_([&](size_t i) { return glm::dvec3(run.flux.punctual[i]); });
  Resumed found;
  found.state.of = state_of_;
  if (!checkpoint_->load(run.sides.level(0), found.state,
                         {&received_direct_, &received_indirect_, &found.residual, &found.direction}))
    return false;
  report = found.state.report;
  resumed_ = std::move(found);
  return true;
}

void BouncesCpu::keep(const Run& run, const BounceReport& report, const Powers& residual, const Powers& direction,
                      glm::dvec3 before, glm::dvec3 qq) {
  if (checkpoint_ == nullptr || run.rules.continues()) return;
  checkpoint_->keep(run.sides.level(0), {report.orders, report, before, qq, state_of_},
                    {&received_direct_, &received_indirect_, &residual, &direction});
}

void BouncesCpu::set_transport(std::unique_ptr<TransportCpu> transport) {
  transport_ = std::move(transport);
  in_flight_ = false;
}

void BouncesCpu::carry(const Powers& sent, const BounceRules& rules, BounceReport& report) {
  const auto start = std::chrono::steady_clock::now();
  received_.assign(sent.size(), glm::vec4(0.0f));
  transport_->carry(sent, received_, rules, report);
  if (report.orders++ == 0) {
    announce_long_run(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), rules);
  }
}

void BouncesCpu::carry_sources(const Powers& sent, const BounceRules& rules, BounceReport& report) {
  transport_->carry_sources(true);
  carry(sent, rules, report);
  transport_->carry_sources(false);
}

void BouncesCpu::send_emission(const Run& run) {
  for_each_side(sent_.size(),
                [&](size_t i) { sent_[i] = glm::vec4(sent_power(run.sides[i], run.flux.emitted[i]), 0.0f); });
}

void BouncesCpu::arrival_of_emission(const Run& run, BounceReport& report) {
  BounceRules by_itself = run.rules;
  if (by_itself.together()) by_itself.iterations.reset();
  send_emission(run);
  report.sent += glm::vec3(total(sent_));
  transport_->stream_in(run.sky);
  carry_sources(sent_, by_itself, report);
  transport_->stream_in(nullptr);
  received_direct_.swap(received_);
}

/// What sides send before bounces. @return what of the last run's answer is the start: as much as the sources have
/// become of what they were, so that lights that were dimmed or put out leave nothing to take back.
glm::vec4 BouncesCpu::set_source(const Run& run) {
  for_each_side(source_.size(), [&](size_t i) {
    const glm::vec3 returned = glm::vec3(response_[i]) * glm::vec3(received_direct_[i]);
    source_[i] = glm::vec4(returned + sent_power(run.sides[i], run.flux.punctual[i]), 0.0f);
  });
  const glm::dvec3 last = source_power_;
  source_power_ = total(source_);
  glm::vec4 share(0.0f);
  for (int band = 0; band < 3; ++band) {
    if (last[band] > 0.0) share[band] = float(source_power_[band] / last[band]);
  }
  return share;
}

/// One order after another, from black: the series K e + K f K e + ...
void BouncesCpu::orders(const Run& run, int limit, BounceReport& report) {
  const BounceRules& rules = run.rules;
  const bool together = transport_->iterative() && rules.together();
  if (rules.iterations && !transport_->iterative()) limit = std::min(limit, *rules.iterations);
  sent_ = resumed_ ? std::move(resumed_->residual) : source_;
  for (bool first = !resumed_; report.orders < limit; first = false) {
    const glm::vec3 sent(total(sent_));
    const bool ended = !rules.bounces && report.orders > 0 && rules.orders_ended(sent, report.sent);
    if (sent == glm::vec3(0.0f) || ended) {
      report.left += sent;
      report.converged = true;
      return;
    }
    if (first) {
      carry_sources(sent_, rules, report);
    } else {
      carry(sent_, rules, report);
    }
    report.sent += sent;
    for_each_side(sent_.size(), [&](size_t i) {
      received_indirect_[i] += received_[i];
      sent_[i] = glm::vec4(glm::vec3(response_[i]) * glm::vec3(received_[i]), 0.0f);
    });
    if (together) return;
    cut_ = rules.bounces && report.orders == limit;
    keep(run, report, sent_, sent_);
  }
}

std::vector<glm::vec4> BouncesCpu::received_but_last() const {
  Powers earlier = received_indirect_;
  if (cut_) for_each_side(earlier.size(), [&](size_t i) { earlier[i] -= received_[i]; });
  return earlier;
}

void BouncesCpu::send_all() {
  for_each_side(sent_.size(), [&](size_t i) {
    sent_[i] = source_[i] + glm::vec4(glm::vec3(response_[i]) * glm::vec3(received_indirect_[i]), 0.0f);
  });
}

/// P becomes what has been received. @return what that changes of what sides send [W].
glm::dvec3 BouncesCpu::publish() {
  const glm::dvec3 change = sums_([&](size_t i) {
    return glm::dvec3(response_[i]) * glm::abs(glm::dvec3(received_[i]) - glm::dvec3(received_indirect_[i]));
  });
  received_indirect_.swap(received_);
  return change;
}

/// P <- K(e + fP) until that changes nothing any more.
void BouncesCpu::renewals(const Run& run, glm::vec4 share, BounceReport& report) {
  for (glm::vec4& power : received_indirect_) power *= share;
  const glm::vec3 emission = report.sent;
  const glm::vec3 emission_left = report.left;
  for (int order = 0; order < BounceRules::kMaxOrders && !report.converged; ++order) {
    send_all();
    report.left = emission_left;
    report.sent = emission + glm::vec3(total(sent_));
    carry(sent_, run.rules, report);
    const glm::vec3 change(publish());
    report.left += change;
    report.converged = run.rules.orders_ended(change, report.sent);
  }
}

void BouncesCpu::begin_order(const Run& run) {
  arrival_in_flight_ = run.has_emission && orders_begun_ % run.rules.arrival_cycle(transport_->iterative()) == 0;
  ++orders_begun_;
  if (arrival_in_flight_) {
    send_emission(run);
  } else {
    set_source(run);
    send_all();
  }
  received_.assign(sent_.size(), glm::vec4(0.0f));
  transport_->stream_in(arrival_in_flight_ ? run.sky : nullptr);
  transport_->begin(sent_);
  in_flight_ = true;
}

/// As many passes as there may be; an order that is not at its end then goes on in the next run.
void BouncesCpu::amortised(const Run& run, BounceReport& report) {
  const int limit = *run.rules.passes_per_run;
  while (report.passes < limit) {
    if (!in_flight_) begin_order(run);
    const int before = report.passes;
    BounceReport carried;
    const bool ended = transport_->advance(received_, limit - before, run.rules, carried);
    report.passes += std::max(carried.passes, 1);
    if (!ended) continue;
    in_flight_ = false;
    ++report.orders;
    report.sent = glm::vec3(total(sent_));
    report.left = carried.left;
    if (arrival_in_flight_) {
      received_direct_.swap(received_);
      report.converged = false;
    } else {
      const glm::vec3 change(publish());
      report.left += change;
      report.converged = run.rules.orders_ended(change, report.sent);
    }
  }
}

std::vector<glm::vec4> BouncesCpu::sent(const VolumeSides& sides, const SideFlux& flux) const {
  std::vector<glm::vec4> all(sides.count());
  for_each_side(all.size(), [&](size_t i) {
    const glm::vec3 received = glm::vec3(received_direct_[i]) + glm::vec3(received_indirect_[i]);
    const glm::vec3 own = sent_power(sides[i], flux.emitted[i] + flux.punctual[i]);
    all[i] = glm::vec4(own + glm::vec3(response_[i]) * received, 0.0f);
  });
  return all;
}

}  // namespace volgi
