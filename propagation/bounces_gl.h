#pragma once
#include <memory>

#include "core/gl/pass_timer.h"
#include "core/gl/program.h"
#include "core/gl/readback.h"
#include "propagation/bounce_rules.h"
#include "propagation/bounce_solver_gl.h"
#include "propagation/resumable_gl.h"
#include "propagation/side_flux_gl.h"
#include "propagation/transport_gl.h"

namespace volgi {

/// Applies a transport operator on the GPU: order by order, where order k sends what sides return of order k-1, or to
/// all orders at once by conjugate gradients (docs/theory.md#orders; the equations are in bounces_cpu.h). Timer
/// "propagation/propagate". Whether a pass was the last is seen while the next one is under way, which then does not
/// count: the GPU never waits for the host, and the result does not depend on timing. The last run's answer is kept,
/// and is where the next one starts where the rules say so.
/// With rules.together() there is one order only, in which hits are sent on at once (iterative schemes).
class BouncesGl {
 public:
  explicit BouncesGl(std::unique_ptr<TransportGl> transport);

  /// @param flux  light in; emission starts first, so that its arrival (direct light) can be told apart.
  /// Amortised runs report what the run before has come to: nobody waits for it.
  /// Says so on stderr when the estimate after the first order exceeds a minute.
  /// @throws Error(usage) as BounceRules::check, and for amortised runs of a scheme whose orders cannot be interrupted.
  BounceReport run(const VoxelGridGl& voxels, const SideFluxGl& flux, bool has_emission, const BounceRules& rules,
                   gl::PassTimer& timer, const Sky* sky = nullptr);

  const gl::Buffer& received_direct() const { return received_direct_; }  // emission's first arrival [W], vec4 a side
  const gl::Buffer& received_indirect() const { return received_indirect_; }  // all later arrivals [W]
  /// received_indirect() without the last order that BounceRules::bounces allows; all of it where orders ended before,
  /// and where their number is not given.
  const gl::Buffer& received_but_last() const { return cut_ ? received_but_last_ : received_indirect_; }
  /// Power per side sent in all orders [W], vec4 a side: what TransportGl::radiance takes.
  gl::Buffer sent(const VoxelGridGl& voxels, const SideFluxGl& flux) const;
  TransportGl& transport() const { return *transport_; }
  size_t bytes() const;
  /// What bytes() will be without the transport's. @param linear  of the transport.
  static size_t bytes_for(std::uint32_t side_capacity, const BounceRules& rules, bool linear);

 private:
  struct Run;
  static bool needs_solver(const BounceRules& rules, bool linear);
  void make_room(const Run& run);
  void next_order(const VoxelGridGl& voxels, const gl::Buffer& total, const gl::Buffer* source, bool already_reflected);
  void request_sent(const VoxelGridGl& voxels);
  glm::vec3 pop_sent();
  void orders(const Run& run, BounceReport& report);
  void arrival_of_emission(const Run& run, BounceReport& report);
  void renewals(const Run& run, BounceReport& report);
  void solve_conjugate(const Run& run, BounceReport& report);
  void begin_order(const Run& run);
  bool advance_order(const Run& run, int max_passes, BounceReport& report);
  void amortised(const Run& run, BounceReport& report);
  bool linear() const { return !transport_->iterative(); }
  BounceSolverGl::Powers powers() const { return {received_, sent_, received_indirect_, received_direct_}; }

  std::unique_ptr<TransportGl> transport_;
  gl::Program next_order_, sum_sent_, sum_partials_;
  gl::Buffer received_, sent_, received_direct_, received_indirect_, sum_, partials_;
  gl::Buffer received_but_last_;  // with a number of bounces
  bool cut_ = false;              // orders came to their limit
  gl::Readback readback_;
  std::unique_ptr<BounceSolverGl> solver_;  // where all bounces are asked for at once
  std::uint32_t capacity_ = 0;
  // Amortised: an order may go on in the next run.
  bool in_flight_ = false, arrival_in_flight_ = false;
  int orders_begun_ = 0;
};

}  // namespace volgi
