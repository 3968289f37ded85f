#pragma once
#include <vector>

#include "propagation/ordinates.h"
#include "propagation/transport_cpu.h"

namespace volgi::test {

/// The step scheme as a TransportCpu, written for reading (docs/theory.md#ordinates).
class StepTransport : public TransportCpu {
 public:
  StepTransport(const VoxelGrid& voxels, int directions) : voxels_(voxels), set_(ordinate_set(directions)) {}

  void begin(std::span<const glm::vec4> sent) override { sent_.assign(sent.begin(), sent.end()); }
  bool advance(std::span<glm::vec4> received, int, const BounceRules&, BounceReport& report) override {
    for (size_t d = 0; d < set_.directions.size(); ++d) {
      for (int octant = 0; octant < 8; ++octant) sweep(d, octant, received);
    }
    report.passes += 1;
    return true;
  }
  bool iterative() const override { return false; }
  bool linear() const override { return true; }
  RadianceVolume radiance(std::span<const glm::vec4>) override { return {}; }
  size_t bytes() const override { return 0; }

 private:
  void sweep(size_t d, int octant, std::span<glm::vec4> received) {
    const Grid& grid = voxels_.grid();
    const glm::vec3 w = set_.directions[d];
    power_.assign(cell_count(grid), glm::vec3(0.0f));
    for (int n = 0; n < int(power_.size()); ++n) {
      glm::ivec3 c = shared::cell_coord(grid, n);
      for (int axis = 0; axis < 3; ++axis) {
        if (((octant >> axis) & 1) == 0) c[axis] = grid.cells[axis] - 1 - c[axis];
      }
      const glm::uvec2 own = voxels_.cell_sides(c);
      glm::vec3& power = power_[size_t(shared::cell_index(grid, c))];
      for (int axis = 0; axis < 3; ++axis) {
        const int upwind = 2 * axis + (((octant >> axis) & 1) == 0 ? 1 : 0);
        if (!shared::has_side(own, upwind)) continue;
        power += glm::vec3(sent_[shared::side_index(own, upwind)]) * (set_.weights[d] * w[axis] / set_.t);
      }
      for (int axis = 0; axis < 3; ++axis) {
        const int downwind = 2 * axis + ((octant >> axis) & 1);
        const glm::vec3 through = power * (w[axis] / (w.x + w.y + w.z));
        const bool side = shared::has_side(own, downwind);
        const float tau = side ? voxels_.sides()[shared::side_index(own, downwind)].coverage : 0.0f;
        if (side) received[shared::side_index(own, downwind)] += glm::vec4(tau * through, 0.0f);
        const glm::ivec3 next = c + shared::face_step(downwind);
        if (shared::cell_inside(grid, next)) power_[size_t(shared::cell_index(grid, next))] += (1.0f - tau) * through;
      }
    }
  }

  const VoxelGrid& voxels_;
  OrdinateSet set_;
  std::vector<glm::vec4> sent_;
  std::vector<glm::vec3> power_;
};

}  // namespace volgi::test
