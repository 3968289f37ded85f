#pragma once
// A closed box with what is hard in it, and transport of power through it.
#include <memory>
#include <random>
#include <vector>

#include "propagation/transport_gl.h"
#include "tests/support/gl_test.h"
#include "tests/support/volume_scenes.h"
#include "tests/support/voxels.h"

namespace volgi::test {

/// Closed box over unit_grid with a tilted opaque panel, a thin wall and a panel that stops 40 %.
inline Scene furnished_box() {
  Scene scene;
  const int grey = add_material(scene, glm::vec3(0.7f, 0.5f, 0.3f));
  const int veil = add_material(scene, glm::vec3(0.5f, 0.6f, 0.8f));
  scene.materials[size_t(veil)].alpha_mode = AlphaMode::blend;
  scene.materials[size_t(veil)].base_color_factor.a = 0.4f;
  add_box_inside(scene, grey, glm::vec3(0.0f), glm::vec3(1.0f));
  add_square(scene, grey, {-0.3f, -0.2f, 0.1f}, {1.0f, 2.0f, -0.5f}, 0.4f);
  add_quad(scene, grey, {0.41f, -1.0f, -1.0f}, {0.0f, 0.0f, 1.2f}, {0.0f, 1.5f, 0.0f});
  add_square(scene, veil, {0.1f, 0.35f, 0.2f}, {0.3f, 1.0f, 0.6f}, 0.5f);
  return scene;
}

using Powers = std::vector<glm::vec4>;

inline Powers random_powers(size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
  Powers p(count);
  for (glm::vec4& v : p) v = {uniform(random), uniform(random), uniform(random), 0.0f};
  return p;
}

inline Powers carry(TransportGl& transport, const VoxelGridGl& voxels, const Powers& sent,
                    BounceReport* report = nullptr) {
  Powers padded = sent;
  padded.resize(voxels.side_capacity, glm::vec4(0.0f));
  const gl::Buffer from(padded);
  const gl::Buffer to(padded.size() * sizeof(glm::vec4));
  to.clear();
  BounceReport ignored;
  transport.carry(voxels, from, to, BounceRules{}, report != nullptr ? *report : ignored);
  return to.download<glm::vec4>(sent.size());
}

inline glm::dvec3 sum(const Powers& p) {
  glm::dvec3 s(0.0);
  for (const glm::vec4& v : p) s += glm::dvec3(v);
  return s;
}

/// Sides that the cell in the middle of the grid can see light of: those that no light leaves the grid from.
inline std::vector<char> inner_sides(const Voxels& v) {
  std::vector<char> start(v.cells.size(), 0);
  start[size_t(shared::cell_index(v.grid, v.grid.cells / 2))] = 1;
  const std::vector<char> reached = v.flood(start);
  std::vector<char> inner;
  for (const Side& side : v.sides) inner.push_back(reached[size_t(side.cell)]);
  return inner;
}

}  // namespace volgi::test
