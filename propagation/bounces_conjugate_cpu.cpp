// Conjugate gradients over bounces: see bounces_cpu.h for the equations.
#include <algorithm>

#include "propagation/bounces_cpu.h"

namespace volgi {

namespace {

using Powers = std::vector<glm::vec4>;

/// <a,b> = sum of a b / (f tau), per band; what sides that return nothing send is not looked for.
glm::dvec3 product(const SideSums& sums, const Powers& response, const Powers& a, const Powers& b) {
  return sums([&](size_t i) {
    glm::dvec3 term(0.0);
    for (int band = 0; band < 3; ++band) {
      const double weight = double(response[i][band]) * double(response[i].w);
      if (weight > 0.0) term[band] = double(a[i][band]) * double(b[i][band]) / weight;
    }
    return term;
  });
}

/// <d, (I - fK) d> where y = K d.
glm::dvec3 curvature(const SideSums& sums, const Powers& response, const Powers& d, const Powers& y) {
  return sums([&](size_t i) {
    glm::dvec3 term(0.0);
    for (int band = 0; band < 3; ++band) {
      const double f = double(response[i][band]);
      const double weight = f * double(response[i].w);
      if (weight > 0.0) term[band] = double(d[i][band]) * (double(d[i][band]) - f * double(y[i][band])) / weight;
    }
    return term;
  });
}

glm::dvec3 magnitude(const SideSums& sums, const Powers& powers) {
  return sums([&](size_t i) { return glm::abs(glm::dvec3(powers[i])); });
}

glm::dvec3 quotient(glm::dvec3 a, glm::dvec3 b) {
  glm::dvec3 q(0.0);
  for (int band = 0; band < 3; ++band) {
    if (b[band] > 0.0) q[band] = a[band] / b[band];
  }
  return q;
}

}  // namespace

/// The first bounce, and what is left of it. @return  false: nothing sends.
bool BouncesCpu::begin_descent(const Run& run, glm::vec4 share, Descent& c, BounceReport& report) {
  const size_t count = source_.size();
  Powers& p = received_indirect_;
  c.q.resize(count);
  c.d.resize(count);
  c.before = glm::dvec3(report.sent);
  // v is what the last answer makes sides send; q = f P - v, with P = K(e + v).
  for_each_side(count, [&](size_t i) {
    c.q[i] = glm::vec4(glm::vec3(response_[i]), 0.0f) * share * p[i];
    sent_[i] = source_[i] + c.q[i];
  });
  if (sums_([&](size_t i) { return glm::dvec3(sent_[i]); }) == glm::dvec3(0.0)) {
    std::fill(p.begin(), p.end(), glm::vec4(0.0f));
    report.converged = true;
    return false;
  }
  carry_sources(sent_, run.rules, report);
  p.swap(received_);
  for_each_side(count, [&](size_t i) {
    c.q[i] = glm::vec4(glm::vec3(response_[i]) * glm::vec3(p[i]), 0.0f) - c.q[i];
    c.d[i] = c.q[i];
  });
  c.qq = product(sums_, response_, c.q, c.q);
  return true;
}

void BouncesCpu::solve_conjugate(const Run& run, glm::vec4 share, BounceReport& report) {
  const BounceRules& rules = run.rules;
  const size_t count = source_.size();
  const int limit =
      std::min(rules.iterations.value_or(BounceRules::kMaxConjugatePasses), BounceRules::kMaxConjugatePasses);
  Powers& p = received_indirect_;
  report.conjugate_gradients = true;
  Descent c;
  if (resumed_) {
    c = {std::move(resumed_->residual), std::move(resumed_->direction), resumed_->state.before,
         resumed_->state.residual};
  } else if (!begin_descent(run, share, c, report)) {
    return;
  }
  for (int pass = report.orders - (run.has_emission ? 1 : 0);; ++pass) {
    keep(run, report, c.q, c.d, c.before, c.qq);
    const glm::vec3 next(magnitude(sums_, c.q));
    report.sent = glm::vec3(c.before + sums_([&](size_t i) {
                              return glm::dvec3(source_[i]) + glm::dvec3(response_[i]) * glm::dvec3(p[i]);
                            }));
    report.converged = rules.orders_ended(next, report.sent);
    if (report.converged || pass == limit) {
      report.left += next;
      break;
    }
    carry(c.d, rules, report);
    const Powers& y = received_;
    // No bounce is taken to lose less than kMinLoss: a closed white room has no answer.
    const glm::dvec3 bend =
        glm::max(curvature(sums_, response_, c.d, y), BounceRules::kMinLoss * product(sums_, response_, c.d, c.d));
    const glm::vec4 alpha(quotient(c.qq, bend), 0.0f);
    for_each_side(count, [&](size_t i) {
      p[i] += alpha * y[i];
      c.q[i] -= alpha * (c.d[i] - glm::vec4(glm::vec3(response_[i]) * glm::vec3(y[i]), 0.0f));
    });
    const glm::dvec3 last = c.qq;
    c.qq = product(sums_, response_, c.q, c.q);
    const glm::vec4 beta(quotient(c.qq, last), 0.0f);
    for_each_side(count, [&](size_t i) { c.d[i] = c.q[i] + beta * c.d[i]; });
  }
  // The answer is not negative, so this takes it nearer where the last steps have overshot.
  for_each_side(count, [&](size_t i) { p[i] = glm::max(p[i], 0.0f); });
}

}  // namespace volgi
