#pragma once
#include <glm/glm.hpp>
#include <memory>
#include <span>

#include "core/sky.h"
#include "propagation/bounce_rules.h"
#include "propagation/passage_face.h"
#include "propagation/radiance_volume.h"
#include "propagation/scheme.h"
#include "voxel/side_halo.h"
#include "voxel/voxel_grid.h"

namespace volgi {

/// A scheme on the CPU: the operator that carries the power which sides send through the grid until sides receive it or
/// it leaves. Twin of TransportGl. No result depends on the number of threads.
class TransportCpu {
 public:
  virtual ~TransportCpu() = default;
  /// Starts an order. @param sent  power per side (rgb) [W], >= 0; w is not looked at. Need not outlive the call.
  virtual void begin(std::span<const glm::vec4> sent) = 0;
  /// From the next begin() on, a sky's light streams in at the grid's rim; null: it is black outside. A scheme without
  /// directions of its own knows no sky.
  virtual void stream_in(const Sky* /*sky*/) {}
  /// Whether the orders begun from now on are of what sources send, which is concentrated and may be worth more
  /// directions (SchemeOptions::many_for_sources).
  virtual void carry_sources(bool /*on*/) {}
  /// From the next begin() on, light goes through these faces, none of which has a side, as through gaps of another
  /// width than cells show. A scheme without a sweep takes no notice.
  /// @param faces  ascending by cell (x fastest) and axis.
  virtual void set_passages([[maybe_unused]] std::span<const PassageFace> faces) {}
  /// Carries the order on, by at most `max_passes` passes over the volume.
  /// @param received  power per side (rgb) [W], added to; w stays.
  /// @param report    passes are added, and, when the order ends, the power that was left in flight.
  /// @return whether the order has ended: nothing in flight, little enough by `rules`, or rules.iterations reached.
  virtual bool advance(std::span<glm::vec4> received, int max_passes, const BounceRules& rules,
                       BounceReport& report) = 0;
  /// One whole order.
  void carry(std::span<const glm::vec4> sent, std::span<glm::vec4> received, const BounceRules& rules,
             BounceReport& report) {
    begin(sent);
    while (!advance(received, 1 << 20, rules, report)) {
    }
  }
  /// Whether an order takes a number of passes that rules.iterations can set.
  virtual bool iterative() const = 0;
  /// Linear and reciprocal, so that conjugate gradients apply.
  virtual bool linear() const = 0;
  /// Radiance that `sent` (all orders together) makes in free space.
  virtual RadianceVolume radiance(std::span<const glm::vec4> sent) = 0;
  virtual size_t bytes() const = 0;
};

/// @param voxels       must outlive the transport.
/// @param half_voxels  the same scene in cells of twice the edge, for the coarse part of `conservative` (may be null).
/// @param ranks, half_ranks  that they are parts of; null: there is one.
/// @throws Error(usage) for a number of directions that there is not, and for schemes that do not carry sides.
std::unique_ptr<TransportCpu> make_transport(const VoxelGrid& voxels, const SchemeOptions& options,
                                             const VoxelGrid* half_voxels = nullptr,
                                             const RanksOfVolume* ranks = nullptr,
                                             const RanksOfVolume* half_ranks = nullptr);

}  // namespace volgi
