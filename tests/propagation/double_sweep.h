#pragma once
// The `ordinates` operator in double precision, one direction after another, written for reading: what the GPU's sweep
// is held to. Transfer through a cell comes from its own integrals, not from ordinates.h.
#include <algorithm>
#include <array>
#include <glm/gtc/constants.hpp>
#include <vector>

#include "propagation/ordinates.h"
#include "tests/support/voxels.h"

namespace volgi::test {

/// Light of the unit direction d comes in, uniform, through the face of axis `in` of a unit cube. With y, z the
/// distances to the other two downwind planes in units of d_y/d_in, d_z/d_in it leaves through the plane that is
/// nearest.
struct CubeTransfer {
  std::array<std::array<double, 3>, 3> share;  // [in][out]
  std::array<double, 3> track;                 // mean length inside

  CubeTransfer(Ordinates rule, glm::dvec3 d) {
    const double s = d.x + d.y + d.z;
    for (int in = 0; in < 3; ++in) {
      for (int out = 0; out < 3; ++out) {
        share[size_t(in)][size_t(out)] = rule == Ordinates::step ? d[out] / s : overlap(d, in, out);
      }
      // E min(1, Y/r, Z/q) = int_0^T (1 - r u)(1 - q u) du with the uniform Y and Z, T = min(1, 1/r, 1/q).
      const double r = d[(in + 1) % 3] / d[in], q = d[(in + 2) % 3] / d[in];
      const double t = std::min({1.0, 1.0 / r, 1.0 / q});
      track[size_t(in)] = rule == Ordinates::step ? 1.0 / s : (t - (r + q) * t * t / 2 + r * q * t * t * t / 3) / d[in];
    }
  }

 private:
  static double overlap(glm::dvec3 d, int in, int out) {
    const int a = (in + 1) % 3, b = (in + 2) % 3;
    if (in == out) return std::max(0.0, 1 - d[a] / d[in]) * std::max(0.0, 1 - d[b] / d[in]);
    // P(Y/r < 1 and Y/r < Z/q) = int_0^Y1 (1 - Y q/r) dY.
    const double r = d[out] / d[in], q_over_r = d[3 - in - out] / d[out];
    const double y1 = std::min({r, 1.0, 1.0 / q_over_r});
    return y1 - q_over_r * y1 * y1 / 2;
  }
};

struct SweepResult {
  std::vector<glm::dvec3> received;                 // by side [W]
  std::array<std::vector<glm::dvec3>, 4> radiance;  // by coefficient 00, y, z, x and cell [W m^-2 sr^-1]
};

/// What one direction of one octant adds. `sent` by side [W].
inline void sweep_direction(const Voxels& v, const OrdinateSet& set, size_t d, Ordinates rule, glm::bvec3 positive,
                            const std::vector<glm::vec4>& sent, SweepResult& result) {
  const glm::dvec3 way = glm::normalize(glm::dvec3(set.directions[d]));
  const CubeTransfer cube(rule, way);
  const double h = double(v.grid.cell_size_m);
  const glm::ivec3 n = v.grid.cells;
  std::vector<std::array<glm::dvec3, 3>> in(v.cells.size());  // by cell and upwind axis
  for (int index = 0; index < int(v.cells.size()); ++index) {
    glm::ivec3 c = shared::cell_coord(v.grid, index);
    for (int axis = 0; axis < 3; ++axis) c[axis] = positive[axis] ? c[axis] : n[axis] - 1 - c[axis];
    const auto cell = size_t(shared::cell_index(v.grid, c));
    std::array<glm::dvec3, 3> out{};
    for (int axis = 0; axis < 3; ++axis) {
      const int upwind = shared::face_of(axis, !positive[axis]);
      glm::dvec3& power = in[cell][size_t(axis)];
      if (shared::has_side(v.cell(c), upwind)) {
        const double share = double(set.weights[d]) * way[axis] / double(set.t);
        power += share * glm::dvec3(sent[shared::side_index(v.cell(c), upwind)]);
      }
      for (size_t b = 0; b < 3; ++b) out[b] += cube.share[size_t(axis)][b] * power;
      const glm::dvec3 mean = double(set.t) / (glm::pi<double>() * h * h) * cube.track[size_t(axis)] * power;
      const glm::dvec3 towards(positive.x ? way.x : -way.x, positive.y ? way.y : -way.y, positive.z ? way.z : -way.z);
      const double y0 = 0.5 / std::sqrt(glm::pi<double>()), y1 = y0 * std::sqrt(3.0);
      result.radiance[0][cell] += y0 * mean;
      result.radiance[1][cell] += y1 * towards.y * mean;
      result.radiance[2][cell] += y1 * towards.z * mean;
      result.radiance[3][cell] += y1 * towards.x * mean;
    }
    for (int axis = 0; axis < 3; ++axis) {
      const int downwind = shared::face_of(axis, positive[axis]);
      const Side* side = v.side(c, downwind);
      const double tau = side != nullptr ? double(side->coverage) : 0.0;
      if (side != nullptr) result.received[shared::side_index(v.cell(c), downwind)] += tau * out[size_t(axis)];
      const glm::ivec3 next = c + shared::face_step(downwind);
      if (shared::cell_inside(v.grid, next)) {
        in[size_t(shared::cell_index(v.grid, next))][size_t(axis)] += (1.0 - tau) * out[size_t(axis)];
      }
    }
  }
}

inline SweepResult double_sweep(const Voxels& v, int directions, Ordinates rule, const std::vector<glm::vec4>& sent) {
  SweepResult result;
  result.received.assign(v.sides.size(), glm::dvec3(0.0));
  for (auto& coefficient : result.radiance) coefficient.assign(v.cells.size(), glm::dvec3(0.0));
  const OrdinateSet set = ordinate_set(directions);
  for (size_t d = 0; d < set.directions.size(); ++d) {
    for (int octant = 0; octant < 8; ++octant) {
      const glm::bvec3 positive((octant & 1) != 0, (octant & 2) != 0, (octant & 4) != 0);
      sweep_direction(v, set, d, rule, positive, sent, result);
    }
  }
  return result;
}

}  // namespace volgi::test
