#pragma once
// What the tests of the CPU's voxels look at.
#include <glm/glm.hpp>
#include <vector>

#include "tests/support/volume_scenes.h"
#include "voxel/voxel_grid.h"

namespace volgi::test {

using shared::Side;

inline const glm::vec3 kRed(0.8f, 0.1f, 0.2f);
inline const glm::vec3 kBlue(0.1f, 0.3f, 0.7f);

inline Grid box_grid(glm::ivec3 cells, float h, glm::vec3 origin) {
  Grid grid{};
  grid.cells = cells;
  grid.cell_size_m = h;
  grid.origin = origin;
  return grid;
}

inline glm::vec3 centre(const Grid& grid, int cell) {
  return shared::world_from_cell(grid, glm::vec3(shared::cell_coord(grid, cell)) + 0.5f);
}

inline const Side* side_of(const VoxelGrid& v, glm::ivec3 cell, int face) {
  const glm::uvec2 own = v.cell_sides(cell);
  return shared::has_side(own, face) ? &v.sides()[shared::side_index(own, face)] : nullptr;
}

/// Cells that light from the marked ones reaches through faces that do not stop everything.
inline std::vector<char> flood(const VoxelGrid& v, std::vector<char> reached) {
  std::vector<int> open;
  for (size_t i = 0; i < reached.size(); ++i) {
    if (reached[i] != 0) open.push_back(int(i));
  }
  while (!open.empty()) {
    const glm::ivec3 c = shared::cell_coord(v.grid(), open.back());
    open.pop_back();
    for (int face = 0; face < 6; ++face) {
      const glm::ivec3 next = c + shared::face_step(face);
      if (!shared::cell_inside(v.grid(), next) || shared::is_opaque(v.cell_sides(c), face)) continue;
      char& mark = reached[size_t(shared::cell_index(v.grid(), next))];
      if (mark == 0) open.push_back(shared::cell_index(v.grid(), next));
      mark = 1;
    }
  }
  return reached;
}

/// Cells for which outside(centre) [m] is above a rounding step that light from around `middle` reaches.
template <class Outside>
int escapes(const VoxelGrid& v, glm::vec3 middle, const Outside& outside) {
  const Grid& grid = v.grid();
  std::vector<char> start(cell_count(grid), 0);
  start[size_t(shared::cell_index(grid, glm::ivec3(shared::cell_from_world(grid, middle))))] = 1;
  const std::vector<char> reached = flood(v, start);
  int count = 0;
  for (int i = 0; i < int(reached.size()); ++i) {
    count += outside(centre(grid, i)) > grid.cell_size_m / 192.0f ? reached[size_t(i)] : 0;
  }
  return count;
}

struct Random {
  std::uint32_t state = 1;
  float operator()() { return float((state = state * 1664525u + 1013904223u) >> 8) * 0x1p-23f - 1.0f; }
  glm::vec3 vec() { return {(*this)(), (*this)(), (*this)()}; }
};

inline Scene mixed_scene() {
  Scene scene;
  const int red = add_material(scene, kRed), blue = add_material(scene, kBlue, glm::vec3(1.0f));
  const int haze = add_material(scene, glm::vec3(0.9f));
  scene.materials[size_t(haze)].alpha_mode = AlphaMode::blend;
  scene.materials[size_t(haze)].base_color_factor.a = 0.4f;
  add_sphere_inside(scene, red, {0.0f, 0.1f, 0.0f}, 0.8f, 24);
  add_square(scene, blue, {0.3f, 0.0f, 0.0f}, {1.0f, 1.0f, 0.3f}, 0.7f);
  add_square(scene, red, {0.3f, 0.0f, 0.0f}, {1.0f, 1.0f, 0.3f}, 0.7f);  // the same place
  add_sphere_inside(scene, haze, {0.1f, 0.1f, 0.2f}, 0.5f, 12);
  return scene;
}

}  // namespace volgi::test
