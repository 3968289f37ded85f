// What cells hold of their surfaces, against what is known of it.
#include "voxel/cell_volumes_gl.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/gl_test.h"
#include "tests/support/volume_scenes.h"

namespace volgi::test {
namespace {

class CellVolumesOnGpu : public GlTest {
 protected:
  static CellVolumesGl::Cells run(const Scene& scene, const Grid& grid) {
    gl::PassTimer timer(context().software(), false);
    CellVolumesGl volumes(grid);
    volumes.run(gl::SceneBuffers(scene), timer);
    return volumes.download();
  }
};

const glm::vec3 kRed(0.8f, 0.1f, 0.2f);
const glm::vec3 kBlue(0.1f, 0.3f, 0.7f);
constexpr float kHalf = 1e-3f;  // of RGBA16F, two roundings

TEST_F(CellVolumesOnGpu, WallFillsItsCells) {
  Scene scene;
  add_square(scene, add_material(scene, kRed, glm::vec3(2.0f, 0.0f, 1e5f)), {0.3f, 0.0f, 0.0f}, {1, 0, 0}, 2.0f);
  const Grid grid = unit_grid(8);
  const CellVolumesGl::Cells cells = run(scene, grid);
  for (int i = 0; i < int(cell_count(grid)); ++i) {
    const auto k = size_t(i);
    const bool wall = shared::cell_coord(grid, i).x == 5;  // 0.3 is at 5.2 cells
    EXPECT_EQ(cells.occupancy[k], wall ? 1.0f : 0.0f);
    EXPECT_LT(glm::distance(cells.albedo[k], wall ? kRed : glm::vec3(0.0f)), kHalf);
    EXPECT_LT(glm::distance(cells.normal[k], glm::vec3(wall ? 1.0f : 0.0f, 0.0f, 0.0f)), kHalf);
    const glm::vec3 emission = wall ? glm::pi<float>() * glm::vec3(2.0f, 0.0f, 1e5f) : glm::vec3(0.0f);
    EXPECT_LT(glm::distance(cells.emission[k], emission), 1e-6f * 1e5f);
  }
}

// Two sheets in one cell: colours mix by area, fronts that look away from each other cancel, occupancy is the largest.
TEST_F(CellVolumesOnGpu, SheetsMixByArea) {
  Scene scene;
  const int red = add_material(scene, kRed), blue = add_material(scene, kBlue);
  scene.materials[size_t(red)].alpha_mode = AlphaMode::blend;
  scene.materials[size_t(red)].base_color_factor.a = 0.25f;
  add_square(scene, red, {0.3f, 0.0f, 0.0f}, {1, 0, 0}, 2.0f);
  add_square(scene, blue, {0.35f, 0.0f, 0.0f}, {-1, 0, 0}, 2.0f);
  const Grid grid = unit_grid(8);
  CellVolumesGl::Cells cells = run(scene, grid);
  const auto k = size_t(shared::cell_index(grid, {5, 3, 3}));
  EXPECT_EQ(cells.occupancy[k], 1.0f);
  EXPECT_LT(glm::distance(cells.albedo[k], (0.25f * kRed + kBlue) / 1.25f), kHalf);
  EXPECT_LT(glm::distance(cells.normal[k], glm::vec3(-1, 0, 0)), kHalf);
  scene.materials[size_t(blue)].alpha_mode = AlphaMode::blend;
  scene.materials[size_t(blue)].base_color_factor.a = 0.25f;
  cells = run(scene, grid);
  EXPECT_NEAR(cells.occupancy[k], 0.25f, kHalf);
  EXPECT_EQ(cells.normal[k], glm::vec3(0.0f));
}

TEST_F(CellVolumesOnGpu, SphereOccupiesWhatItTouches) {
  Scene scene;
  add_sphere_inside(scene, add_material(scene, kRed), glm::vec3(0.0f), 0.7f, 32);
  const Grid grid = unit_grid(20);
  const CellVolumesGl::Cells cells = run(scene, grid);
  int wrong = 0, occupied = 0;
  for (int i = 0; i < int(cell_count(grid)); ++i) {
    const glm::vec3 centre = shared::world_from_cell(grid, glm::vec3(shared::cell_coord(grid, i)) + 0.5f);
    const float distance = std::abs(glm::length(centre) - 0.7f);
    const bool is = cells.occupancy[size_t(i)] > 0.0f;
    occupied += is;
    if (distance > 0.5f * std::sqrt(3.0f) * grid.cell_size_m + 0.01f) wrong += is;
    if (distance < 0.25f * grid.cell_size_m) wrong += !is;
    if (is) {
      EXPECT_GT(glm::dot(cells.normal[size_t(i)], -glm::normalize(centre)), 0.9f);
    }
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_GT(occupied, 500);
}

}  // namespace
}  // namespace volgi::test
