#pragma once
// The exact answer for a closed box: radiosity of the square patches of a 2 m cube's walls, in double precision.
#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <vector>

#include "shaders/shared/grid.shared.h"
#include "shaders/shared/side.shared.h"

namespace volgi::test {

/// Walls of [-1,1]^3 cut into n x n patches. Patch (wall, b, c) is the side of the wall's cells that look at it: wall
/// is the face number of grid.shared.h, (b, c) run along the axes after the wall's own.
class BoxRadiosity {
 public:
  explicit BoxRadiosity(int n) : n_(n) { make_tables(); }

  int patches_on_edge() const { return n_; }
  size_t patch_count() const { return 6 * size_t(n_) * size_t(n_); }
  size_t index(int wall, int b, int c) const {
    return size_t(b) + size_t(n_) * (size_t(c) + size_t(n_) * size_t(wall));
  }
  double patch_area() const { return 4.0 / double(n_ * n_); }

  /// Irradiance of every patch from the radiosity of all.
  std::vector<double> irradiance(const std::vector<double>& radiosity) const {
    std::vector<double> out(patch_count(), 0.0);
    for (int to = 0; to < 6; ++to) {
      for (int from = 0; from < 6; ++from) {
        if (from == to) continue;
        if ((from ^ 1) == to) {
          add_parallel(to, from, radiosity, out);
        } else {
          add_perpendicular(to, from, radiosity, out);
        }
      }
    }
    return out;
  }

  /// Irradiance after each of the first bounces 0, 1, ... of an emitter `emitted` (radiosity), walls of albedo rho.
  std::vector<double> bounce(const std::vector<double>& irradiance_before, double rho) const {
    std::vector<double> radiosity(irradiance_before);
    for (double& b : radiosity) b *= rho;
    return irradiance(radiosity);
  }

 private:
  static constexpr std::array<double, 4> kPoints = {0.06943184420297371, 0.33000947820757187, 0.6699905217924281,
                                                    0.9305681557970263};
  static constexpr std::array<double, 4> kWeights = {0.17392742256872692, 0.32607257743127307, 0.32607257743127307,
                                                     0.17392742256872692};

  /// Form factor from a point at the origin with normal +z to a polygon above its horizon (Lambert's formula).
  static double point_to_rectangle(const std::array<glm::dvec3, 4>& corners) {
    double sum = 0.0;
    for (size_t i = 0; i < 4; ++i) {
      const glm::dvec3 a = glm::normalize(corners[i]);
      const glm::dvec3 b = glm::normalize(corners[(i + 1) % 4]);
      const glm::dvec3 normal = glm::cross(a, b);
      const double length = glm::length(normal);
      if (length < 1e-15) continue;
      sum += std::atan2(length, glm::dot(a, b)) * normal.z / length;
    }
    return std::abs(sum) / (2.0 * M_PI);
  }

  /// Mean over a receiving patch [0,1]^2 (in patches), 4 x 4 Gauss points.
  template <typename F>
  static double mean_over_patch(const F& at) {
    double sum = 0.0;
    for (size_t i = 0; i < 4; ++i) {
      for (size_t j = 0; j < 4; ++j) sum += kWeights[i] * kWeights[j] * at(kPoints[i], kPoints[j]);
    }
    return sum;
  }

  void make_tables() {
    const size_t n = size_t(n_);
    parallel_.resize(n * n);
    perpendicular_.resize(n * n * n);
    for (int j = 0; j < n_; ++j) {
      for (int i = 0; i < n_; ++i) {
        parallel_[size_t(i) + n * size_t(j)] = mean_over_patch([&](double x, double y) {
          const double x0 = i - x, y0 = j - y, z = n_;
          return point_to_rectangle({{{x0, y0, z}, {x0 + 1, y0, z}, {x0 + 1, y0 + 1, z}, {x0, y0 + 1, z}}});
        });
      }
    }
    // Receiver at distance i ... i+1 from the edge, sender at height j ... j+1 above it, k patches along the edge.
    for (int k = 0; k < n_; ++k) {
      for (int j = 0; j < n_; ++j) {
        for (int i = 0; i < n_; ++i) {
          perpendicular_[size_t(i) + n * (size_t(j) + n * size_t(k))] = mean_over_patch([&](double x, double y) {
            const double x0 = -(i + x), y0 = k - y, z0 = j;
            return point_to_rectangle({{{x0, y0, z0}, {x0, y0 + 1, z0}, {x0, y0 + 1, z0 + 1}, {x0, y0, z0 + 1}}});
          });
        }
      }
    }
  }

  void add_parallel(int to, int from, const std::vector<double>& radiosity, std::vector<double>& out) const {
    for (int c = 0; c < n_; ++c) {
      for (int b = 0; b < n_; ++b) {
        double sum = 0.0;
        for (int v = 0; v < n_; ++v) {
          for (int u = 0; u < n_; ++u) {
            sum += parallel_[size_t(std::abs(u - b)) + size_t(n_) * size_t(std::abs(v - c))] *
                   radiosity[index(from, u, v)];
          }
        }
        out[index(to, b, c)] += sum;
      }
    }
  }

  /// Coordinates of a patch on the axes of the box, in patches; its own axis is left 0.
  glm::ivec3 place(int wall, int b, int c) const {
    glm::ivec3 p(0);
    p[shared::axis_b(wall >> 1)] = b;
    p[shared::axis_c(wall >> 1)] = c;
    return p;
  }

  void add_perpendicular(int to, int from, const std::vector<double>& radiosity, std::vector<double>& out) const {
    const int to_axis = to >> 1, from_axis = from >> 1, along = 3 - to_axis - from_axis;
    const auto distance = [&](int coordinate, int wall) { return (wall & 1) != 0 ? n_ - 1 - coordinate : coordinate; };
    for (int c = 0; c < n_; ++c) {
      for (int b = 0; b < n_; ++b) {
        const glm::ivec3 receiver = place(to, b, c);
        const auto i = size_t(distance(receiver[from_axis], from));
        double sum = 0.0;
        for (int v = 0; v < n_; ++v) {
          for (int u = 0; u < n_; ++u) {
            const glm::ivec3 sender = place(from, u, v);
            const auto j = size_t(distance(sender[to_axis], to));
            const auto k = size_t(std::abs(sender[along] - receiver[along]));
            sum += perpendicular_[i + size_t(n_) * (j + size_t(n_) * k)] * radiosity[index(from, u, v)];
          }
        }
        out[index(to, b, c)] += sum;
      }
    }
  }

  int n_;
  std::vector<double> parallel_, perpendicular_;
};

/// The same walls as sides of a grid of `cells` on an edge, in the order cell by cell; patch_of[i] is the patch (of
/// `radiosity`, whose patches may be coarser) that side i lies on.
struct BoxSides {
  shared::Grid grid{};
  std::vector<shared::Side> sides;
  std::vector<size_t> patch_of;

  BoxSides(const BoxRadiosity& radiosity, int cells, float albedo) {
    grid.cells = glm::ivec3(cells);
    grid.cell_size_m = 2.0f / float(cells);
    grid.origin = glm::vec3(-1.0f);
    const int cells_per_patch = cells / radiosity.patches_on_edge();
    for (int i = 0; i < cells * cells * cells; ++i) {
      const glm::ivec3 c = shared::cell_coord(grid, i);
      for (int face = 0; face < 6; ++face) {
        const int axis = face >> 1;
        if (c[axis] != ((face & 1) != 0 ? cells - 1 : 0)) continue;
        shared::Side side{};
        side.normal[axis] = (face & 1) != 0 ? -1.0f : 1.0f;
        side.coverage = 1.0f;
        side.albedo = glm::vec3(albedo);
        side.face_m2 = grid.cell_size_m * grid.cell_size_m;
        side.area_m2 = side.face_m2;
        side.cell = i;
        side.face = face;
        side.depth = float((face & 1) != 0 ? cells : 0);
        side.front = 1;
        sides.push_back(side);
        patch_of.push_back(radiosity.index(face, c[shared::axis_b(axis)] / cells_per_patch,
                                           c[shared::axis_c(axis)] / cells_per_patch));
      }
    }
  }
};

}  // namespace volgi::test
