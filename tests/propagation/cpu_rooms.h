#pragma once
// Rooms of sides without a scene, and transports that are easy to trust, for tests of what is built on them.
#include <glm/glm.hpp>
#include <random>
#include <vector>

#include "propagation/side_flux.h"
#include "propagation/transport_cpu.h"
#include "tests/propagation/step_transport.h"
#include "tests/support/volume_scenes.h"

namespace volgi::test {

using Powers = std::vector<glm::vec4>;

inline glm::dvec3 sum(const Powers& powers) {
  glm::dvec3 s(0.0);
  for (const glm::vec4& p : powers) s += glm::dvec3(p);
  return s;
}

/// Rooms of size^3 cells in a row along x, walls of albedo rho and no thickness; each opens into the next by a door of
/// size/4 x size/2 cells.
inline VoxelGrid rooms_in_a_row(int rooms, int size, glm::vec3 rho) {
  Grid grid{};
  grid.cells = {rooms * size, size, size};
  grid.cell_size_m = 2.0f / float(size);
  grid.origin = glm::vec3(-1.0f);
  const auto blocked = [&](glm::ivec3 cell, int face) {
    const glm::ivec3 next = cell + shared::face_step(face);
    if (!shared::cell_inside(grid, next)) return true;
    const bool door = cell.y < size / 2 && std::abs(2 * cell.z + 1 - size) < size / 4;
    return next.x / size != cell.x / size && !door;
  };
  std::vector<shared::Side> sides;
  for (int i = 0; i < int(cell_count(grid)); ++i) {
    for (int face = 0; face < 6; ++face) {
      if (!blocked(shared::cell_coord(grid, i), face)) continue;
      shared::Side side{};
      side.normal = -glm::vec3(shared::face_step(face));
      side.coverage = 1.0f;
      side.albedo = rho;
      side.area_m2 = side.face_m2 = grid.cell_size_m * grid.cell_size_m;
      side.cell = i;
      side.face = face;
      side.depth = float(shared::cell_coord(grid, side.cell)[face >> 1] + (face & 1));
      sides.push_back(side);
    }
  }
  return VoxelGrid(grid, std::move(sides));
}

/// Flux on the ceiling's middle of room `room`: 1/4 of its width on each edge.
inline SideFlux ceiling_light(const VoxelGrid& voxels, int room, glm::vec3 flux) {
  SideFlux light;
  light.emitted.assign(voxels.side_count(), glm::vec4(0.0f));
  light.punctual = light.emitted;
  const int size = voxels.grid().cells.y;
  for (size_t i = 0; i < voxels.side_count(); ++i) {
    const glm::ivec3 c = shared::cell_coord(voxels.grid(), voxels.sides()[i].cell);
    const bool middle =
        std::abs(2 * (c.x - room * size) + 1 - size) < size / 4 && std::abs(2 * c.z + 1 - size) < size / 4;
    if (voxels.sides()[i].face == 3 && middle) light.punctual[i] = glm::vec4(flux, 0.0f);
  }
  return light;
}

/// received = tau S sent, S given: no volume at all.
class MatrixTransport : public TransportCpu {
 public:
  using Matrix = std::vector<std::vector<double>>;
  MatrixTransport(Matrix s, const VoxelGrid& voxels) : s_(std::move(s)), voxels_(voxels) {}

  void begin(std::span<const glm::vec4> sent) override { sent_.assign(sent.begin(), sent.end()); }
  bool advance(std::span<glm::vec4> received, int, const BounceRules&, BounceReport& report) override {
    for (size_t i = 0; i < s_.size(); ++i) {
      glm::dvec4 hit(0.0);
      for (size_t j = 0; j < s_.size(); ++j) hit += s_[i][j] * glm::dvec4(sent_[j]);
      received[i] += glm::vec4(glm::dvec3(hit) * double(voxels_.sides()[i].coverage), 0.0f);
    }
    report.passes += 1;
    return true;
  }
  bool iterative() const override { return false; }
  bool linear() const override { return true; }
  RadianceVolume radiance(std::span<const glm::vec4>) override { return {}; }
  size_t bytes() const override { return 0; }

 protected:
  Matrix s_;
  const VoxelGrid& voxels_;
  Powers sent_;
};

/// The same as a pulse: each pass brings half of what is still in flight to where it goes.
class PulseTransport : public MatrixTransport {
 public:
  using MatrixTransport::MatrixTransport;
  void begin(std::span<const glm::vec4> sent) override {
    MatrixTransport::begin(sent);
    at_start_ = in_flight_ = glm::vec3(sum(sent_));
    for (glm::vec4& power : sent_) power *= 0.5f;
  }
  bool advance(std::span<glm::vec4> received, int max_passes, const BounceRules& rules, BounceReport& report) override {
    for (int pass = 0; pass < max_passes; ++pass) {
      MatrixTransport::advance(received, 1, rules, report);
      for (glm::vec4& power : sent_) power *= 0.5f;
      in_flight_ *= 0.5f;
      if (!rules.pulse_ended(in_flight_, at_start_)) continue;
      report.left += in_flight_;
      return true;
    }
    return false;
  }
  bool iterative() const override { return true; }
  bool linear() const override { return false; }

 private:
  glm::vec3 at_start_{0.0f}, in_flight_{0.0f};
};

/// Symmetric; with coverage tau, no side sends more than it has: the columns of tau S sum to less than 1.
inline MatrixTransport::Matrix random_exchange(const VoxelGrid& voxels, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  const size_t count = voxels.side_count();
  MatrixTransport::Matrix s(count, std::vector<double>(count));
  double largest = 0.0;
  for (size_t i = 0; i < count; ++i) {
    for (size_t j = 0; j <= i; ++j) s[i][j] = s[j][i] = std::pow(uniform(random), 8.0);
  }
  for (const std::vector<double>& row : s) {
    double column = 0.0;
    for (size_t j = 0; j < count; ++j) column += row[j] * double(voxels.sides()[j].coverage);
    largest = std::max(largest, column);
  }
  for (std::vector<double>& row : s) {
    for (double& v : row) v *= 0.999 / largest;
  }
  return s;
}

}  // namespace volgi::test
