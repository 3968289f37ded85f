#include "propagation/bounce_rules.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/error.h"
#include "core/log.h"

namespace volgi {

float BounceRules::absorption() const { return std::max(1.0f - largest_albedo, kMinAbsorption); }

bool BounceRules::pulse_ended(glm::vec3 in_flight, glm::vec3 sent) const {
  return glm::all(glm::lessThanEqual(in_flight, kTolerance * absorption() * sent));
}

bool BounceRules::orders_ended(glm::vec3 next_sent, glm::vec3 total_sent) const {
  return glm::all(glm::lessThanEqual(next_sent / absorption(), kTolerance * weakest * total_sent));
}

int BounceRules::expected_orders() const {
  if (bounces) return *bounces;
  float rho = 1.0f - absorption();
  if (rho <= 0.0f) return 1;
  // Orders shrink by the mean albedo of what they hit, which is below rho_max: this is an upper bound.
  return std::max(1, int(std::ceil(std::log(kTolerance * absorption()) / std::log(rho))));
}

void BounceRules::check(bool linear) const {
  const auto refuse = [](const char* what) { throw Error(ExitCode::usage, what); };
  if (passes_per_run && *passes_per_run < 1) refuse("amortised bounces: at least 1 pass a run is needed");
  if (passes_per_run && bounces) {
    refuse("amortised bounces carry all of them, run after run: leave out either the passes a run or --bounces");
  }
  if (passes_per_run && iterations) {
    refuse(
        "amortised bounces never count iterations from the start: leave out either the passes a run or --iterations");
  }
  if (solver != Solver::conjugate_gradients) return;
  if (!linear) refuse("conjugate gradients need a linear scheme: use --scheme ordinates or the plain solver");
  if (bounces) refuse("conjugate gradients find all bounces at once: leave out --bounces or use the plain solver");
  if (passes_per_run) refuse("amortised bounces are plain ones: leave out conjugate gradients or the passes a run");
}

bool BounceRules::conjugate_gradients(bool linear) const {
  if (solver != Solver::automatic) return solver == Solver::conjugate_gradients;
  return linear && !bounces && !iterations && !passes_per_run;
}

int BounceRules::arrival_cycle(bool iterative) const { return iterative ? 2 : std::max(2, passes_per_run.value_or(2)); }

void announce_long_run(double seconds_per_order, const BounceRules& rules) {
  const double estimate = seconds_per_order * rules.expected_orders();
  if (rules.together() || estimate < 60.0) return;
  warn_once("light propagation is going to take up to " + std::to_string(int(estimate)) + " s (largest albedo " +
            std::to_string(rules.largest_albedo).substr(0, 4) + "); --bounces or a smaller --grid shorten it");
}

}  // namespace volgi
