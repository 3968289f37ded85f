#pragma once
#include <glm/glm.hpp>
#include <optional>

namespace volgi {

/// When the solver stops: its rules apart from where it runs (conventions; techniques, "Transport operator and
/// orders").
struct BounceRules {
  /// Reflections to carry: N orders for punctual light, N+1 for emission, whose arrival is bounce 0. None: all of them.
  std::optional<int> bounces;
  /// Passes over the volume: of each order with `bounces`, else in all, with reflections in flight together. Schemes
  /// that carry an order in one pass take it as the most orders.
  std::optional<int> iterations;
  /// Conjugate gradients over bounces instead of one order after another, where the scheme allows it (linear, all
  /// bounces, no warm start of plain orders asked for).
  enum class Solver { automatic, plain, conjugate_gradients };
  Solver solver = Solver::automatic;
  /// Amortised: at most this many passes over the volume a run, starting from the last run's answer. None: until done.
  /// A usage error together with `bounces`, and with schemes that have no answer to start from.
  std::optional<int> passes_a_run;
  /// rho_max: the scene's largest albedo.
  float largest_albedo = 0.5f;

  /// Share of the light that stopping early may cost: 0.2 %.
  static constexpr float kTolerance = 2e-3f;
  /// An albedo of 1 would never end: what is left after 1 % absorption a bounce is asked for then.
  static constexpr float kLeastAbsorption = 0.01f;

  float absorption() const;
  /// All orders in flight together: what orders there are cannot be told apart afterwards.
  bool together() const { return iterations && !bounces; }
  /// The order ends: power in flight under kTolerance (1 - rho_max) of what was sent, in every band.
  bool pulse_ended(glm::vec3 in_flight, glm::vec3 sent) const;
  /// Orders end: what the next order would send, over (1 - rho_max), under kTolerance of all that was sent.
  bool orders_ended(glm::vec3 next_sent, glm::vec3 total_sent) const;
  /// Orders that follow from the albedo alone; for estimates only.
  int expected_orders() const;
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

}  // namespace volgi
