#pragma once
// The `conservative` scheme in double precision with transfers by quadrature, written for reading: what the GPU's
// passes are held to. Nothing of it comes from sh.shared.h but the least share that a face passes.
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <vector>

#include "shaders/shared/sh.shared.h"
#include "tests/support/voxels.h"

namespace volgi::test {

/// Lobes are coefficients of sqrt(4 pi) Y_lm, order 00, y, z, x, xy, yz, 20, xz, 22: the first is the power.
using Lobe = std::array<double, 9>;

class DoubleLobes {
 public:
  DoubleLobes(const Voxels& voxels, int order) : voxels_(voxels), count_(order == 1 ? 4 : 9) {
    integrate();
    lobes_.assign(3 * voxels.cells.size(), Lobe{});
    received.assign(voxels.sides.size(), glm::dvec3(0.0));
  }

  void emit(const std::vector<glm::vec4>& sent) {
    for (size_t i = 0; i < sent.size(); ++i) {
      const Side& side = voxels_.sides[i];
      // Isotropic light through the face opposite to the side's, of power 1: a sixth of the isotropic lobe goes there.
      for (int band = 0; band < 3; ++band) {
        for (int k = 0; k < count_; ++k) {
          at(side.cell, band)[size_t(k)] +=
              6.0 * double(sent[i][band]) * transfer_[size_t(shared::opposite_face(side.face))][size_t(k)][0];
        }
      }
    }
    for (Lobe& lobe : lobes_) rescale(lobe);
  }

  void pass() {
    std::vector<Lobe> next(lobes_.size(), Lobe{});
    for (int cell = 0; cell < int(voxels_.cells.size()); ++cell) {
      const glm::ivec3 c = shared::cell_coord(voxels_.grid, cell);
      for (int face = 0; face < 6; ++face) {
        const Side* side = voxels_.side(c, face);
        const double tau = side != nullptr ? double(side->coverage) : 0.0;
        const glm::ivec3 to = c + shared::face_step(face);
        for (int band = 0; band < 3; ++band) {
          const double power = passed(at(cell, band), face);
          if (power == 0.0) continue;
          if (side != nullptr) received[shared::side_index(voxels_.cell(c), face)][band] += tau * power;
          if (!shared::cell_inside(voxels_.grid, to)) continue;
          Lobe& into = next[size_t(3 * shared::cell_index(voxels_.grid, to) + band)];
          for (int k = 0; k < count_; ++k) into[size_t(k)] += (1.0 - tau) * through(at(cell, band), face, k);
        }
      }
    }
    lobes_ = std::move(next);
    for (Lobe& lobe : lobes_) rescale(lobe);
  }

  std::vector<glm::dvec3> received;  // by side [W]

 private:
  Lobe& at(int cell, int band) { return lobes_[size_t(3 * cell + band)]; }
  double through(const Lobe& lobe, int face, int k) const {
    double sum = 0.0;
    for (int j = 0; j < count_; ++j) sum += transfer_[size_t(face)][size_t(k)][size_t(j)] * lobe[size_t(j)];
    return sum;
  }
  double passed(const Lobe& lobe, int face) const {
    const double power = through(lobe, face, 0);
    return power > double(shared::FLUX_MIN_SHARE) * lobe[0] ? power : 0.0;
  }
  void rescale(Lobe& lobe) const {
    double sum = 0.0;
    for (int face = 0; face < 6; ++face) sum += passed(lobe, face);
    const double factor = sum > 0.0 ? lobe[0] / sum : 0.0;
    for (double& x : lobe) x *= factor;
  }

  static Lobe basis(glm::dvec3 d) {
    const double a = std::sqrt(3.0), b = std::sqrt(15.0);
    return {1.0,
            a * d.y,
            a * d.z,
            a * d.x,
            b * d.x * d.y,
            b * d.y * d.z,
            std::sqrt(5.0) * (1.5 * d.z * d.z - 0.5),
            b * d.x * d.z,
            0.5 * b * (d.x * d.x - d.y * d.y)};
  }

  /// The flux through the face over the flux through all of them.
  void integrate() {
    constexpr int kSteps = 200;  // midpoints along an edge of the cube, error about 1e-5
    Lobe all{};
    for (int pyramid = 0; pyramid < 6; ++pyramid) {
      for (int n = 0; n < kSteps * kSteps; ++n) {
        const double u = (2 * (n % kSteps) + 1.0) / kSteps - 1.0, v = (2 * (n / kSteps) + 1.0) / kSteps - 1.0;
        const double r = std::sqrt(1.0 + u * u + v * v);
        const int axis = shared::face_axis(pyramid);
        glm::dvec3 d;
        d[axis] = shared::face_sign(pyramid) / r;
        d[(axis + 1) % 3] = u / r;
        d[(axis + 2) % 3] = v / r;
        const double measure = 4.0 / (kSteps * kSteps) / (r * r * r) / (4.0 * glm::pi<double>());
        add(d, measure, all);
      }
    }
    for (auto& face : transfer_) {
      for (size_t i = 0; i < 9; ++i) {
        for (size_t j = 0; j < 9; ++j) face[i][j] /= all[i];
      }
    }
  }
  void add(glm::dvec3 d, double measure, Lobe& all) {
    const Lobe b = basis(d);
    for (size_t i = 0; i < 9; ++i) all[i] += measure * (std::abs(d.x) + std::abs(d.y) + std::abs(d.z)) * b[i] * b[i];
    for (int face = 0; face < 6; ++face) {
      const double flux = shared::face_sign(face) * d[shared::face_axis(face)];
      if (flux <= 0.0) continue;
      for (size_t i = 0; i < 9; ++i) {
        for (size_t j = 0; j < 9; ++j) transfer_[size_t(face)][i][j] += measure * flux * b[i] * b[j];
      }
    }
  }

  const Voxels& voxels_;
  int count_;
  std::array<std::array<Lobe, 9>, 6> transfer_{};  // [face][out][in]
  std::vector<Lobe> lobes_;                        // by cell and band
};

}  // namespace volgi::test
