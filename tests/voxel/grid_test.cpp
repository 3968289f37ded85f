#include "voxel/grid.h"

#include <gtest/gtest.h>

#include <set>

#include "core/error.h"
#include "tests/support/volume_scenes.h"

namespace volgi::test {
namespace {

Grid odd_grid() {
  Grid grid{};
  grid.cells = {3, 5, 7};
  grid.cell_size_m = 0.25f;
  grid.origin = {-1.0f, 2.0f, 0.5f};
  return grid;
}

TEST(Grid, CellIndexAndCoordinatesAreInverse) {
  const Grid grid = odd_grid();
  for (int i = 0; i < int(cell_count(grid)); ++i) {
    const glm::ivec3 c = shared::cell_coord(grid, i);
    EXPECT_TRUE(shared::cell_inside(grid, c));
    EXPECT_EQ(shared::cell_index(grid, c), i);
  }
  EXPECT_EQ(shared::cell_index(grid, {1, 0, 0}), 1);   // x fastest
  EXPECT_EQ(shared::cell_index(grid, {0, 0, 1}), 15);  // z slowest
}

TEST(Grid, LiesAroundABoxIfThereIsOne) {
  Scene scene;
  add_quad(scene, add_material(scene, glm::vec3(0.5f)), {-100.0f, 0.0f, -100.0f}, {0.0f, 0.0f, 200.0f},
           {200.0f, 0.0f, 0.0f});
  const GridBox room{{-2.0f, 0.0f, -1.0f}, {2.0f, 2.0f, 1.0f}};
  const Grid grid = make_grid(scene, 32, glm::vec3(0.0f), room);
  EXPECT_EQ(grid.cells, glm::ivec3(32, 16, 16));
  EXPECT_EQ(grid.origin, room.min);
  EXPECT_EQ(grid_cells_by_size(scene, room), 48);
  EXPECT_EQ(grid_cells_by_size(scene), 128);  // more of its cells lie in no height
}

TEST(Grid, FaceIndexAndCoordinatesAreInverse) {
  const Grid grid = odd_grid();
  for (int axis = 0; axis < 3; ++axis) {
    std::set<int> seen;
    glm::ivec3 counts = grid.cells;
    counts[axis] += 1;
    for (int z = 0; z < counts.z; ++z) {
      for (int y = 0; y < counts.y; ++y) {
        for (int x = 0; x < counts.x; ++x) {
          const int index = shared::face_index(grid, axis, {x, y, z});
          EXPECT_EQ(shared::face_coord(grid, axis, index), glm::ivec3(x, y, z));
          seen.insert(index);
        }
      }
    }
    EXPECT_EQ(int(seen.size()), shared::face_count(grid, axis));
    EXPECT_EQ(*seen.begin(), 0);
    EXPECT_EQ(*seen.rbegin(), shared::face_count(grid, axis) - 1);
  }
}

TEST(Grid, FacesOfACell) {
  for (int face = 0; face < 6; ++face) {
    EXPECT_EQ(shared::face_of(shared::face_axis(face), shared::face_sign(face) > 0), face);
    EXPECT_EQ(shared::face_step(face) + shared::face_step(shared::opposite_face(face)), glm::ivec3(0));
    EXPECT_EQ(shared::face_step(face)[shared::face_axis(face)], shared::face_sign(face));
  }
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_EQ(std::set<int>({axis, shared::axis_b(axis), shared::axis_c(axis)}).size(), 3u);
    EXPECT_EQ(shared::axis_b(axis), (axis + 1) % 3);
  }
}

TEST(Grid, WorldAndCellUnitsAreInverse) {
  const Grid grid = odd_grid();
  const glm::vec3 world(0.3f, 2.71f, 1.9f);
  const glm::vec3 back = shared::world_from_cell(grid, shared::cell_from_world(grid, world));
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(back[axis], world[axis], 1e-6f);
  EXPECT_EQ(shared::cell_from_world(grid, grid.origin), glm::vec3(0.0f));
}

// A surface blocks the segment between two cell centres that it lies between: centres are at 0.5, 1.5 ...
TEST(Grid, FaceOfDepth) {
  for (bool below : {false, true}) {
    EXPECT_EQ(shared::face_of_depth(-0.2f, below), 0);
    EXPECT_EQ(shared::face_of_depth(0.49f, below), 0);
    EXPECT_EQ(shared::face_of_depth(0.51f, below), 1);
    EXPECT_EQ(shared::face_of_depth(1.0f, below), 1);
    EXPECT_EQ(shared::face_of_depth(31.7f, below), 32);
  }
  // A wall through the centres of cells falls on one side of all of them, whatever the rounding.
  for (int face : {1, 8, 64, 128, 1024}) {
    const float centre = float(face) - 0.5f;
    for (float error : {-1e-3f, -2e-5f, -1e-5f, 0.0f, 1e-5f, 2e-5f, 1e-3f}) {
      EXPECT_EQ(shared::face_of_depth(centre + error, false), face) << centre << " + " << error;
      EXPECT_EQ(shared::face_of_depth(centre + error, true), face - 1) << centre << " + " << error;
    }
  }
}

TEST(Grid, FallsBelowCentreAsAllCentresMove) {
  EXPECT_TRUE(shared::falls_below_centre({0.0f, 1.0f, 0.0f}, 1));
  EXPECT_TRUE(shared::falls_below_centre({0.0f, -1.0f, 0.0f}, 1));
  EXPECT_TRUE(shared::falls_below_centre({0.6f, 0.0f, 0.8f}, 2));
  EXPECT_FALSE(shared::falls_below_centre({-0.6f, 0.0f, 0.8f}, 2));
  EXPECT_TRUE(shared::falls_below_centre({-0.6f, 0.0f, 0.8f}, 0));
}

Scene scene_of_size(glm::vec3 size, glm::vec3 centre = glm::vec3(0.0f)) {
  Scene scene;
  add_box_inside(scene, add_material(scene, glm::vec3(0.5f)), centre, 0.5f * size);
  return scene;
}

TEST(MakeGrid, LongestAxisHasTheCellsAndOthersAreRoundedUp) {
  const Grid grid = make_grid(scene_of_size({4.0f, 1.01f, 0.3f}, {10.0f, -3.0f, 1.0f}), 8);
  EXPECT_EQ(grid.cells, glm::ivec3(8, 3, 1));
  EXPECT_FLOAT_EQ(grid.cell_size_m, 0.5f);
  const glm::vec3 centre = grid.origin + 0.5f * grid.cell_size_m * glm::vec3(grid.cells);
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(centre[axis], glm::vec3(10.0f, -3.0f, 1.0f)[axis], 1e-6f);
}

TEST(MakeGrid, RoundingAddsNoCell) {
  EXPECT_EQ(make_grid(scene_of_size({3.0f, 1.0000001f, 2.0f}), 6).cells, glm::ivec3(6, 2, 4));
  EXPECT_EQ(make_grid(scene_of_size({0.7f, 0.1f, 0.3f}), 21).cells, glm::ivec3(21, 3, 9));
}

TEST(MakeGrid, ShiftAddsACellAndKeepsTheBoundsInside) {
  const Scene scene = scene_of_size({2.0f, 2.0f, 1.0f});
  const Grid plain = make_grid(scene, 16);
  for (float shift : {0.25f, 0.5f, -0.25f}) {
    const Grid grid = make_grid(scene, 16, glm::vec3(shift));
    EXPECT_EQ(grid.cells, plain.cells + 1);
    EXPECT_FLOAT_EQ(grid.cell_size_m, plain.cell_size_m);
    for (int axis = 0; axis < 3; ++axis) {
      const float cells_moved = (grid.origin[axis] - plain.origin[axis]) / grid.cell_size_m;
      EXPECT_NEAR(cells_moved - std::floor(cells_moved), shift - std::floor(shift), 1e-4f);
      EXPECT_LE(grid.origin[axis], scene.bounds_min[axis] + 1e-6f);
      EXPECT_GE(grid.origin[axis] + grid.cell_size_m * float(grid.cells[axis]), scene.bounds_max[axis] - 1e-6f);
    }
  }
  EXPECT_EQ(make_grid(scene, 16, {0.25f, 0.0f, 0.0f}).cells, glm::ivec3(17, 16, 8));
}

TEST(MakeGrid, RefusesWhatHasNoGrid) {
  EXPECT_THROW(make_grid(scene_of_size(glm::vec3(1.0f)), 0), Error);
  EXPECT_THROW(make_grid(Scene{}, 8), Error);
  Scene point;
  add_quad(point, add_material(point, glm::vec3(0.5f)), glm::vec3(1.0f), glm::vec3(0.0f), glm::vec3(0.0f));
  EXPECT_THROW(make_grid(point, 8), Error);
}

}  // namespace
}  // namespace volgi::test
