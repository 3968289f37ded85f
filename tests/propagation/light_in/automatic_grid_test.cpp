#include "propagation/light_in/automatic_grid.h"

#include <gtest/gtest.h>

#include "tests/support/paths.h"
#include "tests/support/volume_scenes.h"
#include "voxel/grid.h"

namespace volgi::test {
namespace {

// What is right for a room stays: more cells would cost and bring nothing (docs/results/grid.md).
TEST(AutomaticGrid, RoomsKeepTheCellsOfTheirSize) {
  for (const char* name : {"cornell", "thin_wall", "room", "corridor", "emissive", "room704", "closed_box"}) {
    const Scene scene = load_scene(source_dir() / "data" / (std::string(name) + ".glb"));
    EXPECT_EQ(automatic_grid_cells(scene), grid_cells_by_size(scene)) << name;
  }
}

/// A lit plate close under the ceiling of a room of 4 m.
Scene slit(float gap_m) {
  Scene scene;
  add_box_inside(scene, add_material(scene, glm::vec3(0.7f)), glm::vec3(0.0f), glm::vec3(2.0f));
  const int glowing = add_material(scene, glm::vec3(0.5f), glm::vec3(10.0f));
  add_box(scene, glowing, {0.0f, 2.0f - gap_m - 0.01f, 0.0f}, {0.3f, 0.01f, 0.3f});
  return scene;
}

// Half of the lamp's light flies from it to the ceiling.
TEST(AutomaticGrid, CellsFollowShortFlights) {
  const int far = automatic_grid_cells(slit(0.5f)), near = automatic_grid_cells(slit(0.05f));
  EXPECT_EQ(far, 48);
  EXPECT_GT(near, 70);
  EXPECT_LE(cell_count(make_grid(slit(0.05f), near)), size_t(1) << 20);
}

TEST(AutomaticGrid, DarkScenesHaveOne) {
  Scene scene;
  add_box_inside(scene, add_material(scene, glm::vec3(0.7f)), glm::vec3(0.0f), glm::vec3(2.0f));
  EXPECT_EQ(automatic_grid_cells(scene), 48);
}

}  // namespace
}  // namespace volgi::test
