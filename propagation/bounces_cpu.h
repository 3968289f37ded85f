#pragma once
#include <memory>
#include <optional>
#include <vector>

#include "propagation/bounce_checkpoint.h"
#include "propagation/bounce_rules.h"
#include "propagation/side_flux.h"
#include "propagation/side_loops.h"
#include "propagation/transport_cpu.h"

namespace volgi {

/// Applies a transport operator on the CPU: order by order, or to all orders at once by conjugate gradients; twin of
/// BouncesGl (docs/theory.md#orders). The last run's answer is kept, and is where the next one starts where the rules
/// say so. No result depends on the number of threads, nor on that of ranks. Memory: six powers (16 bytes) a side.
///
/// Conjugate gradients: with K from sent to received power, f the returned fraction and e what the sources send, the
/// power P that sides receive solves P = K(e + fP). S = K/tau of the receiving side is symmetric, so I - fK is
/// self-adjoint and positive in the product <a,b> = sum of a b / (f tau) over what sides send, and is solved there; in
/// u = P sqrt(f/tau) that is (I - √(fτ) S √(fτ)) u = √(fτ) S e (docs/theory.md#orders). Where faces are of several
/// sizes (a cascade's), tau is times their area. Every step's K d is added up into P, which makes P = K(e + v) of the
/// sought v = fP: one plain bounce from v, also where f = 0, at no cost. The residual q = fP - v is what that bounce
/// changes of what sides send, so orders_ended() speaks of both solvers alike.
class BouncesCpu {
 public:
  /// @param ranks  that the voxels are parts of (the transport's); null: there is one.
  explicit BouncesCpu(std::unique_ptr<TransportCpu> transport, const Ranks* ranks = nullptr)
      : transport_(std::move(transport)), ranks_(ranks) {}

  /// @throws Error(usage) as BounceRules::check.
  /// @param sky  streams in with the arrival of emission, and is arrival alike; null: none.
  BounceReport run(const VolumeSides& sides, const SideFlux& flux, bool has_emission, const BounceRules& rules,
                   const Sky* sky = nullptr);
  /// Later runs keep their state there and go on from one that is there; null: none. Not amortised or warm ones, and of
  /// one grid.
  void set_checkpoint(BounceCheckpoint* checkpoint) { checkpoint_ = checkpoint; }
  /// For voxels that have changed: the answer stays, as the next run's start; an amortised order in flight does not.
  void set_transport(std::unique_ptr<TransportCpu> transport);

  const std::vector<glm::vec4>& received_direct() const { return received_direct_; }  // emission's first arrival [W]
  const std::vector<glm::vec4>& received_indirect() const { return received_indirect_; }  // all later arrivals [W]
  /// The same without the last order that BounceRules::bounces allows; all of it where orders ended before.
  std::vector<glm::vec4> received_but_last() const;
  /// Power per side sent in all orders [W]: what the radiance in free space follows from.
  std::vector<glm::vec4> sent(const VolumeSides& sides, const SideFlux& flux) const;
  TransportCpu& transport() const { return *transport_; }
  /// Of the powers of so many sides; the transport's own are apart.
  static size_t bytes_for(size_t sides) { return 6 * sizeof(glm::vec4) * sides; }

 private:
  using Powers = std::vector<glm::vec4>;
  struct Run {
    const VolumeSides& sides;
    const SideFlux& flux;
    bool has_emission;  // or sky
    const BounceRules& rules;
    const Sky* sky;
  };
  void make_room(const Run& run);
  void carry(const Powers& sent, const BounceRules& rules, BounceReport& report);
  /// An order with what sources send in it (TransportCpu::carry_sources).
  void carry_sources(const Powers& sent, const BounceRules& rules, BounceReport& report);
  void send_emission(const Run& run);
  void arrival_of_emission(const Run& run, BounceReport& report);
  glm::vec4 set_source(const Run& run);
  void orders(const Run& run, int limit, BounceReport& report);
  bool go_on(const Run& run, BounceReport& report);
  void keep(const Run& run, const BounceReport& report, const Powers& residual, const Powers& direction,
            glm::dvec3 before = {}, glm::dvec3 qq = {});
  void send_all();
  glm::dvec3 publish();
  void renewals(const Run& run, glm::vec4 share, BounceReport& report);
  /// Conjugate gradients between two passes.
  struct Descent {
    Powers q, d;                      // residual, direction
    glm::dvec3 before{0.0}, qq{0.0};  // sent by emission [W]; <q,q>
  };
  bool begin_descent(const Run& run, glm::vec4 share, Descent& c, BounceReport& report);
  void solve_conjugate(const Run& run, glm::vec4 share, BounceReport& report);
  void begin_order(const Run& run);
  void amortised(const Run& run, BounceReport& report);

  glm::dvec3 total(const Powers& powers) const {
    return sums_([&](size_t i) { return glm::dvec3(powers[i]); });
  }

  std::unique_ptr<TransportCpu> transport_;
  const Ranks* ranks_;
  SideSums sums_;
  BounceCheckpoint* checkpoint_ = nullptr;
  /// Where a run has gone on from.
  struct Resumed {
    BounceState state;
    Powers residual, direction;
  };
  std::optional<Resumed> resumed_;
  BounceState::Of state_of_;  // this run's
  Powers received_direct_, received_indirect_;
  Powers response_;                  // rgb: returned fraction f, w: coverage tau
  Powers source_, sent_, received_;  // what sides send before bounces, what they send and receive in this order [W]
  glm::dvec3 source_power_{0.0};     // of the last run, in all [W]
  // Amortised: an order may go on in the next run.
  bool in_flight_ = false, arrival_in_flight_ = false;
  int orders_begun_ = 0;
  bool cut_ = false;  // orders came to their limit: received_ is the last one's
};

/// Irradiance per side [W m^-2] for pixels, twin of SideIrradianceGl: smoothed over 3^3 cells, then clamped at zero.
struct SideIrradiance {
  std::vector<glm::vec4> direct, indirect;  // rgb; w is 1
};
/// @param halo  of a rank's voxels: what others have at the sides beside its own; null: there are no others.
SideIrradiance side_irradiance(const VoxelGrid& voxels, const SideFlux& flux, const BouncesCpu& bounces,
                               const SideHalo* halo = nullptr);
/// The same with received_but_last().
SideIrradiance side_irradiance_but_last(const VoxelGrid& voxels, const SideFlux& flux, const BouncesCpu& bounces);
/// Of one level of a volume, of which `flux` and `bounces` are; of its sides alone.
SideIrradiance side_irradiance_of_level(const VolumeSides& sides, size_t level, const SideFlux& flux,
                                        const BouncesCpu& bounces, const SideHalo* halo = nullptr);

}  // namespace volgi
