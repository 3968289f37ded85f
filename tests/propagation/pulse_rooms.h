#pragma once
// Voxels that no scene made, and a pulse through them written for reading, for tests of the SH schemes on the CPU.
#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/glm.hpp>
#include <random>
#include <vector>

#include "shaders/shared/grid.shared.h"
#include "shaders/shared/sh.shared.h"
#include "shaders/shared/side.shared.h"
#include "voxel/voxel_grid.h"

namespace volgi::test {

using Powers = std::vector<glm::vec4>;

inline glm::dvec3 sum(const Powers& powers) {
  glm::dvec3 s(0.0);
  for (const glm::vec4& p : powers) s += glm::dvec3(p);
  return s;
}

inline Powers random_powers(size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
  Powers p(count);
  for (glm::vec4& v : p) v = {uniform(random), uniform(random), uniform(random), 0.0f};
  return p;
}

inline Grid small_grid(glm::ivec3 cells, float cell_size_m = 0.25f) {
  Grid grid{};
  grid.cells = cells;
  grid.cell_size_m = cell_size_m;
  grid.origin = -0.5f * cell_size_m * glm::vec3(cells);
  return grid;
}

/// Sides where `coverage(cell, face)` is not 0; both cells of a face must get the same answer.
inline VoxelGrid voxels_of(const Grid& grid, float albedo, const std::function<float(glm::ivec3, int)>& coverage) {
  std::vector<shared::Side> sides;
  for (int i = 0; i < int(cell_count(grid)); ++i) {
    const glm::ivec3 cell = shared::cell_coord(grid, i);
    for (int face = 0; face < 6; ++face) {
      const float tau = coverage(cell, face);
      if (tau <= 0.0f) continue;
      shared::Side side{};
      side.normal = -glm::vec3(shared::face_step(face));
      side.coverage = tau;
      side.albedo = glm::vec3(albedo, 0.5f * albedo, 0.25f * albedo);
      side.area_m2 = side.face_m2 = tau * grid.cell_size_m * grid.cell_size_m;
      side.cell = i;
      side.face = face;
      side.depth = float(cell[face >> 1] + (face & 1));
      side.front = 1;
      sides.push_back(side);
    }
  }
  return VoxelGrid(grid, std::move(sides));
}

inline VoxelGrid closed_box(glm::ivec3 cells, float albedo, float cell_size_m = 0.25f) {
  const Grid grid = small_grid(cells, cell_size_m);
  return voxels_of(grid, albedo, [&](glm::ivec3 cell, int face) {
    return shared::cell_inside(grid, cell + shared::face_step(face)) ? 0.0f : 1.0f;
  });
}

/// The lower cell of a face and its axis make one random number for both its cells.
inline float face_number(const Grid& grid, glm::ivec3 cell, int face, unsigned seed) {
  const glm::ivec3 low = (face & 1) == 0 ? cell + shared::face_step(face) : cell;
  const glm::ivec3 padded = low + 1;
  const unsigned index = unsigned(padded.x + (grid.cells.x + 2) * (padded.y + (grid.cells.y + 2) * padded.z));
  unsigned hash = seed + 3u * index + unsigned(face >> 1);  // PCG's output function
  hash = hash * 747796405u + 2891336453u;
  hash = ((hash >> ((hash >> 28) + 4u)) ^ hash) * 277803737u;
  return float(((hash >> 22) ^ hash) >> 8) / float(1 << 24);
}

/// Faces blocked at random: one in seven inside, of which half stop a part only; two of three on the outside.
inline VoxelGrid clutter(glm::ivec3 cells, float albedo, unsigned seed) {
  const Grid grid = small_grid(cells);
  return voxels_of(grid, albedo, [&](glm::ivec3 cell, int face) {
    const float u = face_number(grid, cell, face, seed);
    if (!shared::cell_inside(grid, cell + shared::face_step(face))) return u < 0.6f ? 1.0f : u < 0.7f ? 0.3f : 0.0f;
    return u < 0.07f ? 1.0f : u < 0.14f ? 7.0f * (u - 0.07f) + 0.2f : 0.0f;
  });
}

/// A closed surface of two faces, back to back, in the middle of an open grid.
inline VoxelGrid plate_in_void(int cells, int plate_cells) {
  const Grid grid = small_grid(glm::ivec3(cells));
  const int middle = cells / 2;
  return voxels_of(grid, 0.5f, [&](glm::ivec3 cell, int face) {
    const int x = face == 0 ? cell.x : face == 1 ? cell.x + 1 : -1;
    const auto near = [&](int c) { return c >= middle && c < middle + plate_cells; };
    return x == middle && near(cell.y) && near(cell.z) ? 1.0f : 0.0f;
  });
}

/// The `conservative` scheme in double precision, its matrices by quadrature over the sphere.
class PlainPulse {
 public:
  PlainPulse(const VoxelGrid& voxels, int order)
      : voxels_(voxels), n_(order == 1 ? 4 : 9), lobes_(3 * cell_count(voxels.grid()) * size_t(n_), 0.0) {
    make_transfer();
  }

  void begin(const Powers& sent) {
    std::fill(lobes_.begin(), lobes_.end(), 0.0);
    for_sides([&](glm::ivec3 cell, int face, std::uint32_t side) {
      for (int band = 0; band < 3; ++band) send(lobes_, cell, face, band, double(sent[side][band]));
    });
    rescale(lobes_);
  }

  void pass(std::vector<glm::dvec3>& received, bool reflect_hits) {
    const Grid& grid = voxels_.grid();
    std::vector<double> next(lobes_.size(), 0.0);
    for (int i = 0; i < int(cell_count(grid)); ++i) {
      const glm::ivec3 cell = shared::cell_coord(grid, i);
      const glm::uvec2 sides = voxels_.cell_sides(cell);
      for (int face = 0; face < 6; ++face) {
        const glm::ivec3 to = cell + shared::face_step(face);
        const bool has_side = shared::has_side(sides, face);
        const std::uint32_t side = has_side ? shared::side_index(sides, face) : 0;
        const double tau = has_side ? double(voxels_.sides()[side].coverage) : 0.0;
        for (int band = 0; band < 3; ++band) {
          const double power = row(face, 0, at(lobes_, cell, band));
          if (power <= kMinShareOfLobe * at(lobes_, cell, band)[0]) continue;
          if (has_side) received[side][band] += tau * power;
          if (has_side && reflect_hits)
            send(next, cell, face, band, tau * power * double(voxels_.sides()[side].albedo[band]));
          if (!shared::cell_inside(grid, to)) continue;
          for (int k = 0; k < n_; ++k) at(next, to, band)[k] += (1.0 - tau) * row(face, k, at(lobes_, cell, band));
        }
      }
    }
    rescale(next);
    lobes_.swap(next);
  }

  double lobe(glm::ivec3 cell, int band, int k) { return at(lobes_, cell, band)[k]; }

 private:
  double* at(std::vector<double>& lobes, glm::ivec3 cell, int band) const {
    return &lobes[(3 * size_t(shared::cell_index(voxels_.grid(), cell)) + size_t(band)) * size_t(n_)];
  }
  double row(int face, int k, const double* lobe) const {
    double r = 0.0;
    for (int j = 0; j < n_; ++j) r += transfer_[face][k][j] * lobe[j];
    return r;
  }
  /// As one sixth of isotropic light comes in through the face.
  void send(std::vector<double>& lobes, glm::ivec3 cell, int face, int band, double power) const {
    for (int k = 0; k < n_; ++k) at(lobes, cell, band)[k] += 6.0 * power * transfer_[face ^ 1][k][0];
  }
  template <class F>
  void for_sides(const F& f) const {
    for (std::uint32_t s = 0; s < voxels_.side_count(); ++s)
      f(shared::cell_coord(voxels_.grid(), voxels_.sides()[s].cell), voxels_.sides()[s].face, s);
  }
  void rescale(std::vector<double>& lobes) const {
    for (size_t i = 0; i < lobes.size(); i += size_t(n_)) {
      double sum = 0.0;
      for (int face = 0; face < 6; ++face) {
        const double power = row(face, 0, &lobes[i]);
        if (power > kMinShareOfLobe * lobes[i]) sum += power;
      }
      const double factor = sum > 0.0 ? lobes[i] / sum : 0.0;
      for (int k = 0; k < n_; ++k) lobes[i + size_t(k)] *= factor;
    }
  }
  void make_transfer();

  const VoxelGrid& voxels_;
  int n_;
  static constexpr double kMinShareOfLobe = 0x1p-16;
  std::vector<double> lobes_;
  double transfer_[6][9][9] = {};
};

/// f(direction, solid angle) over the sphere, midpoint rule in equal angles.
template <class F>
void over_sphere(const F& f) {
  constexpr int n = 256;
  const auto tangent = [](int i) { return std::tan(M_PI / 4.0 * ((2.0 * i + 1.0) / n - 1.0)); };
  for (int face = 0; face < 6; ++face) {
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) {
        const double u = tangent(i), v = tangent(j), r = std::sqrt(1.0 + u * u + v * v);
        glm::dvec3 d;
        d[face >> 1] = ((face & 1) != 0 ? 1.0 : -1.0) / r;
        d[((face >> 1) + 1) % 3] = u / r;
        d[((face >> 1) + 2) % 3] = v / r;
        f(d, (1.0 + u * u) * (1.0 + v * v) / (r * r * r) * (M_PI * M_PI / 4.0) / double(n * n));
      }
    }
  }
}

/// sqrt(4 pi) Y_lm, from the definitions (no Condon-Shortley sign: docs/conventions.md#spherical-harmonics).
inline void basis_at(glm::dvec3 d, double b[9]) {
  b[0] = 1.0;
  b[1] = std::sqrt(3.0) * d.y;
  b[2] = std::sqrt(3.0) * d.z;
  b[3] = std::sqrt(3.0) * d.x;
  b[4] = std::sqrt(15.0) * d.x * d.y;
  b[5] = std::sqrt(15.0) * d.y * d.z;
  b[6] = std::sqrt(5.0) / 2.0 * (3.0 * d.z * d.z - 1.0);
  b[7] = std::sqrt(15.0) * d.x * d.z;
  b[8] = std::sqrt(15.0) / 2.0 * (d.x * d.x - d.y * d.y);
}

inline void PlainPulse::make_transfer() {
  double norm[9] = {};
  over_sphere([&](glm::dvec3 d, double solid_angle) {
    double b[9];
    basis_at(d, b);
    const double shown = std::abs(d.x) + std::abs(d.y) + std::abs(d.z);
    for (int k = 0; k < n_; ++k) norm[k] += shown * solid_angle / (4.0 * M_PI) * b[k] * b[k];
    for (int face = 0; face < 6; ++face) {
      const double along = (face & 1) != 0 ? d[face >> 1] : -d[face >> 1];
      const double weight = std::max(along, 0.0);
      for (int k = 0; k < n_ && weight > 0.0; ++k) {
        for (int j = 0; j < n_; ++j) transfer_[face][k][j] += weight * solid_angle / (4.0 * M_PI) * b[k] * b[j];
      }
    }
  });
  for (auto& face : transfer_) {
    for (int k = 0; k < n_; ++k) {
      for (int j = 0; j < n_; ++j) face[k][j] /= norm[k];
    }
  }
}

}  // namespace volgi::test
