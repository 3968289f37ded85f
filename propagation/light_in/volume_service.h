#pragma once
#include <glm/glm.hpp>
#include <vector>

#include "propagation/volume_cpu.h"

namespace volgi {

/// A volume that ranks hold together for pictures that the first of them makes: that one leads, the others serve. What
/// the leader does with its own VolumeCpu the others do with theirs, each its part; of what all have found the leader
/// fetches the sides that its picture reads.
class VolumeLead {
 public:
  /// A new volume of these options, on all ranks; the leader's own VolumeCpu is made after it. The ranks must outlive
  /// this.
  VolumeLead(const Ranks& ranks, const VolumeOptions& options);

  /// The leader's volume is about to run, with its grid there: voxelize(), light_in(), propagate(), irradiate().
  void run(glm::vec3 grid_shift_cells) const;
  /// After them. Figures of all ranks: sides, and flux that they send [W].
  struct Totals {
    size_t sides = 0;
    glm::dvec3 injected{0.0};
  };
  static Totals totals(const VolumeCpu& volume);

  /// Sides of some blocks of the grid, and what they have: as voxels of a whole grid that has no others.
  struct Sides {
    VoxelGrid voxels;
    SideIrradiance irradiance;
    size_t bytes() const;
  };
  /// @param blocks  x fastest: those whose sides are wanted. Memory and messages: 96 bytes a side of them.
  Sides fetch(const VolumeCpu& volume, const std::vector<bool>& blocks) const;

 private:
  const Ranks& ranks_;
};

/// Blocks with the cells that a picture may read at these points of surfaces (propagation/pixel_irradiance_cpu.h).
/// @param positions  world; where w is 0 there is none.
std::vector<bool> blocks_seen(const Grid& grid, std::span<const glm::vec4> positions);

/// All ranks but the first: does what it says, until it says that this is the end. @param scene  the same as its own.
void serve_volume(const Scene& scene, const Ranks& ranks);
/// The first rank: the others return from serve_volume().
void end_volume_service(const Ranks& ranks);

}  // namespace volgi
