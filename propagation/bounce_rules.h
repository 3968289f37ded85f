#pragma once
#include <glm/glm.hpp>
#include <optional>

namespace volgi {

/// When the solver stops: its rules apart from where it runs (docs/theory.md#orders).
struct BounceRules {
  /// Reflections to carry: N orders for punctual light, N+1 for emission, whose arrival is bounce 0. After a first
  /// bounce on the screen it is one less than asked for: what virtual lights bring to sides and those reflect arrives
  /// again as bounce 2 of punctual light, N-1 orders, but as bounce 1 of emission, N orders. None: all of them.
  std::optional<int> bounces;
  /// Passes over the volume: of each order with `bounces`, else in all, with reflections in flight together. Schemes
  /// that carry an order in one pass take it as the most orders.
  std::optional<int> iterations;
  /// rho_max: the scene's largest albedo.
  float largest_albedo = 0.5f;
  /// What the weaker of two kinds of light sends, over the stronger one, that from outside and that of lamps within: a
  /// room on a ground that the sky lights is not done when the ground is.
  float weakest = 1.0f;
  /// Conjugate gradients over bounces instead of one order after another. Automatic: where the scheme is linear and all
  /// bounces are asked for. A usage error where it is not, and with `bounces` and `passes_per_run`.
  enum class Solver { automatic, plain, conjugate_gradients };
  Solver solver = Solver::automatic;
  /// Amortised: at most this many passes over the volume a run, one bounce after another, P <- K(e + fP), from the last
  /// run's answer (black at first). None: until done. A usage error together with `bounces` and `iterations`.
  std::optional<int> passes_per_run;
  /// Starts from the last run's answer where there is one of as many sides and all bounces are asked for. The answer is
  /// that of a cold start to kTolerance in a linear scheme. Others then solve P = K(e + fP), all light in one pulse,
  /// which is not the sum of their orders.
  bool warm_start = false;

  /// Share of the light that stopping early may cost: 0.2 %.
  static constexpr float kTolerance = 2e-3f;
  /// No `weakest` is less: kTolerance of it is what sums of floats resolve.
  static constexpr float kWeakest = 1e-3f;
  /// An albedo of 1 would never end: what is left after 1 % absorption a bounce is asked for then.
  static constexpr float kMinAbsorption = 0.01f;
  /// 0.2 % at the largest albedo that counts, 0.99, needs 1,300.
  static constexpr int kMaxOrders = 5000;
  /// Conjugate gradients take no bounce to lose less than this part (in the mean over all sides), or a closed white
  /// room would have no answer; and no more passes than that can need, sqrt(1/kMinLoss) / 2 · ln(2 / (kTolerance /
  /// 100)).
  static constexpr double kMinLoss = 1e-4;
  static constexpr int kMaxConjugatePasses = 600;

  float absorption() const;
  /// All orders in flight together: what orders there are cannot be told apart afterwards.
  bool together() const { return iterations && !bounces; }
  /// The order ends: power in flight under kTolerance (1 - rho_max) of what was sent, in every band.
  bool pulse_ended(glm::vec3 in_flight, glm::vec3 sent) const;
  /// Orders end: what one more would change of what sides send (that is, what the next order would send), over
  /// (1 - rho_max), under kTolerance of all that was sent, times `weakest`. A bound: K brings no more than was sent and
  /// sides return rho_max of it at most, so the next order changes rho_max times that, and so on.
  bool orders_ended(glm::vec3 next_sent, glm::vec3 total_sent) const;
  /// Orders that follow from the albedo alone; for estimates only.
  int expected_orders() const;

  /// @throws Error(usage) for rules that make no sense together, naming them. @param linear  of the scheme.
  void check(bool linear) const;
  bool conjugate_gradients(bool linear) const;
  /// Whether the last run's answer may be the start.
  bool continues() const { return passes_per_run || (warm_start && !bounces && !iterations); }
  /// Amortised, with emission: one order in a number of them renews its first arrival, the others carry bounces. Once a
  /// run where an order is one pass.
  int arrival_cycle(bool iterative) const;
};

/// What the solver did, for --stats and for warnings.
struct BounceReport {
  int orders = 0;        // transport orders run
  int passes = 0;        // over the volume
  glm::vec3 sent{0.0f};  // power sent by sides in all orders [W]
  glm::vec3 left{0.0f};  // power not carried to its end: in flight, or not sent any more [W]
  bool converged = false;
  bool conjugate_gradients = false;
};

/// Says so on stderr when the estimate after the first order exceeds a minute.
void announce_long_run(double seconds_per_order, const BounceRules& rules);

}  // namespace volgi
