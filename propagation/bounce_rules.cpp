#include "propagation/bounce_rules.h"

#include <algorithm>
#include <cmath>

namespace volgi {

float BounceRules::absorption() const { return std::max(1.0f - largest_albedo, kLeastAbsorption); }

bool BounceRules::pulse_ended(glm::vec3 in_flight, glm::vec3 sent) const {
  return glm::all(glm::lessThanEqual(in_flight, kTolerance * absorption() * sent));
}

bool BounceRules::orders_ended(glm::vec3 next_sent, glm::vec3 total_sent) const {
  return glm::all(glm::lessThanEqual(next_sent / absorption(), kTolerance * total_sent));
}

int BounceRules::expected_orders() const {
  if (bounces) return *bounces;
  float rho = 1.0f - absorption();
  if (rho <= 0.0f) return 1;
  // Orders shrink by the mean albedo of what they hit, which is below rho_max: this is an upper bound.
  return std::max(1, int(std::ceil(std::log(kTolerance * absorption()) / std::log(rho))));
}

}  // namespace volgi
