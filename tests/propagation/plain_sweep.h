#pragma once
// One order of `ordinates` as plainly as it can be written: what the sweeps of any processor must agree with.
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <vector>

#include "propagation/ordinates.h"
#include "voxel/voxel_grid.h"

namespace volgi::test {

/// One order by the formulas, cell after cell, in double precision.
struct Plain {
  std::vector<glm::dvec3> received;
  glm::dvec3 left{0.0};
  std::vector<std::array<glm::dvec3, 4>> sh;  // by cell_index: 00, 1-1, 10, 11
};

class PlainSweep {
 public:
  PlainSweep(const VoxelGrid& voxels, OrdinateChoice choice, const std::vector<glm::vec4>& sent)
      : voxels_(voxels), choice_(choice), set_(ordinate_set(choice.directions)), sent_(sent) {
    plain_.received.assign(sent.size(), glm::dvec3(0.0));
    plain_.sh.resize(cell_count(voxels.grid()));
    for (int octant = 0; octant < 8; ++octant) {
      for (size_t d = 0; d < set_.directions.size(); ++d) sweep(octant, d);
    }
  }
  const Plain& result() const { return plain_; }

 private:
  void sweep(int octant, size_t d) {
    const Grid& grid = voxels_.grid();
    const glm::ivec3 sign = 2 * glm::ivec3(octant & 1, (octant >> 1) & 1, octant >> 2) - 1;
    std::vector<glm::dvec3> leaving(3 * cell_count(grid));  // [3 cell + axis]
    for (int i = 0; i < int(cell_count(grid)); ++i) {
      const glm::ivec3 along = shared::cell_coord(grid, i);
      glm::ivec3 cell;
      for (int a = 0; a < 3; ++a) cell[a] = sign[a] > 0 ? along[a] : grid.cells[a] - 1 - along[a];
      visit(cell, sign, d, leaving);
    }
  }

  void visit(glm::ivec3 cell, glm::ivec3 sign, size_t d, std::vector<glm::dvec3>& leaving) {
    const Grid& grid = voxels_.grid();
    const glm::uvec2 own = voxels_.cell_sides(cell);
    const glm::dvec3 emitted(set_.emitted_share(d));
    const CellTransfer transfer = cell_transfer(choice_.rule, set_.directions[d]);
    const glm::dvec3 track(radiance_per_watt(set_, d, choice_.rule, grid.cell_size_m));
    glm::dvec3 in[3] = {glm::dvec3(0.0), glm::dvec3(0.0), glm::dvec3(0.0)}, mean(0.0);
    const int index = shared::cell_index(grid, cell);
    for (int a = 0; a < 3; ++a) {
      glm::ivec3 before = cell;
      before[a] -= sign[a];
      if (shared::cell_inside(grid, before)) in[a] = leaving[size_t(3 * shared::cell_index(grid, before) + a)];
      const int face = shared::face_of(a, sign[a] < 0);
      if (shared::has_side(own, face)) {
        const size_t side = shared::side_index(own, face);
        in[a] = in[a] * (1.0 - double(voxels_.sides()[side].coverage)) + emitted[a] * glm::dvec3(sent_[side]);
      }
      mean += track[a] * in[a];
    }
    for (int a = 0; a < 3; ++a) {
      glm::dvec3 out(0.0);
      for (int from = 0; from < 3; ++from) out += double(transfer.share[from][a]) * in[from];
      leaving[size_t(3 * index + a)] = out;
      const int face = shared::face_of(a, sign[a] > 0);
      double tau = 0.0;
      if (shared::has_side(own, face)) {
        const size_t side = shared::side_index(own, face);
        tau = double(voxels_.sides()[side].coverage);
        plain_.received[side] += tau * out;
      }
      glm::ivec3 next = cell;
      next[a] += sign[a];
      if (!shared::cell_inside(grid, next)) plain_.left += (1.0 - tau) * out;
    }
    const glm::dvec3 direction = glm::dvec3(set_.directions[d]) * glm::dvec3(sign);
    const double y00 = std::sqrt(0.25 / glm::pi<double>()), y1 = std::sqrt(3.0) * y00;
    auto& sh = plain_.sh[size_t(index)];
    sh[0] += y00 * mean;
    sh[1] += y1 * direction.y * mean;
    sh[2] += y1 * direction.z * mean;
    sh[3] += y1 * direction.x * mean;
  }

  const VoxelGrid& voxels_;
  OrdinateChoice choice_;
  OrdinateSet set_;
  const std::vector<glm::vec4>& sent_;
  Plain plain_;
};

}  // namespace volgi::test
