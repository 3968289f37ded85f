#pragma once
// Voxels that no scene made: blocked faces where a test wants them.
#include <array>
#include <functional>
#include <random>
#include <vector>

#include "voxel/voxel_grid.h"

namespace volgi::test {

/// Coverage of the face between the cells `c` - e_axis and `c` (c[axis] from 0 to cells[axis]), 0 where it is open.
using Coverage = std::function<float(int axis, glm::ivec3 c)>;

/// Sides of all faces that `coverage` names, flat (A = m), with one albedo.
inline VoxelGrid make_voxels(glm::ivec3 cells, float cell_size_m, const Coverage& coverage, float albedo = 0.5f) {
  Grid grid{};
  grid.cells = cells;
  grid.cell_size_m = cell_size_m;
  std::vector<shared::Side> sides;
  for (int index = 0; index < int(cell_count(grid)); ++index) {
    const glm::ivec3 cell = shared::cell_coord(grid, index);
    for (int face = 0; face < 6; ++face) {
      const int axis = shared::face_axis(face);
      glm::ivec3 at = cell;
      at[axis] += face & 1;
      const float tau = coverage(axis, at);
      if (tau <= 0.0f) continue;
      shared::Side side{};
      side.normal = -glm::vec3(shared::face_step(face));
      side.coverage = tau;
      side.albedo = glm::vec3(albedo, 0.8f * albedo, 0.5f * albedo);
      side.face_m2 = side.area_m2 = tau * cell_size_m * cell_size_m;
      side.cell = index;
      side.face = face;
      sides.push_back(side);
    }
  }
  return {grid, std::move(sides)};
}

/// Walls all around and nothing inside.
inline VoxelGrid closed_box(glm::ivec3 cells, float cell_size_m, float albedo = 0.5f) {
  return make_voxels(
      cells, cell_size_m,
      [cells](int axis, glm::ivec3 c) { return c[axis] == 0 || c[axis] == cells[axis] ? 1.0f : 0.0f; }, albedo);
}

/// Coverage by a hash of the face: `walls` of the outer faces and `inner` of the others are there, half of those
/// opaque.
inline Coverage random_faces(glm::ivec3 cells, float walls, float inner, unsigned seed) {
  std::array<std::vector<float>, 3> faces;
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
  for (int axis = 0; axis < 3; ++axis) {
    for (int i = 0; i < (cells.x + 1) * (cells.y + 1) * (cells.z + 1); ++i) {
      const float exists = uniform(random), opaque = uniform(random), tau = uniform(random);
      faces[size_t(axis)].push_back(exists > inner ? (exists < walls ? -1.0f : 0.0f) : opaque < 0.5f ? 1.0f : tau);
    }
  }
  return [cells, faces](int axis, glm::ivec3 c) {
    const float f = faces[size_t(axis)][size_t(c.x + (cells.x + 1) * (c.y + (cells.y + 1) * c.z))];
    const bool outer = c[axis] == 0 || c[axis] == cells[axis];
    return f < 0.0f ? (outer ? 1.0f : 0.0f) : f;
  };
}

using Powers = std::vector<glm::vec4>;

inline Powers random_powers(size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
  Powers p(count);
  for (glm::vec4& v : p) v = {uniform(random), uniform(random), uniform(random), 0.0f};
  return p;
}

inline glm::dvec3 sum(const Powers& p) {
  glm::dvec3 s(0.0);
  for (const glm::vec4& v : p) s += glm::dvec3(v);
  return s;
}

}  // namespace volgi::test
