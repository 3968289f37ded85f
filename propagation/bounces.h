#pragma once
#include <memory>
#include <vector>

#include "propagation/bounce_rules.h"
#include "propagation/side_flux.h"
#include "propagation/transport.h"

namespace volgi {

/// Applies a transport operator order by order on the CPU, or all orders at once by conjugate gradients; twin of
/// BouncesGl (docs/theory.md#orders). State is kept from run to run: the last run's answer is where the next one starts
/// (rules.warm_start).
class Bounces {
 public:
  explicit Bounces(std::unique_ptr<Transport> transport) : transport_(std::move(transport)) {}

  BounceReport run(const VoxelGrid& voxels, const SideFlux& flux, bool has_emission, const BounceRules& rules);

  const std::vector<glm::vec4>& received_direct() const { return received_direct_; }  // emission's first arrival [W]
  const std::vector<glm::vec4>& received_indirect() const { return received_indirect_; }  // all later arrivals [W]
  /// Power per side sent in all orders [W]: what the radiance in free space follows from.
  std::vector<glm::vec4> sent(const VoxelGrid& voxels, const SideFlux& flux) const;
  Transport& transport() const { return *transport_; }

 private:
  std::unique_ptr<Transport> transport_;
  std::vector<glm::vec4> received_direct_, received_indirect_;
};

/// Irradiance per side [W m^-2] for pixels, twin of SideIrradianceGl: smoothed over 3^3 cells, then clamped at zero.
struct SideIrradiance {
  std::vector<glm::vec4> direct, indirect;  // rgb; w is 1
};
SideIrradiance side_irradiance(const VoxelGrid& voxels, const SideFlux& flux, const Bounces& bounces);

}  // namespace volgi
