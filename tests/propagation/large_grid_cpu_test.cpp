// Grids up to 1024 cells along an axis on the CPU: memory by surfaces and one plane of sweep state, said before; the
// same answer whether octants take turns or not.
#include <gtest/gtest.h>

#include "core/error.h"
#include "propagation/light_in/direct_light_cpu.h"
#include "propagation/transport_ordinates_cpu.h"
#include "propagation/volume_cpu.h"
#include "tests/propagation/synthetic_voxels.h"
#include "tests/support/volume_scenes.h"
#include "voxel/voxelize_cpu.h"

namespace volgi::test {
namespace {

TEST(LargeGridCpu, OctantsInTurnGiveTheSameBytes) {
  const glm::ivec3 cells(21, 17, 30);
  const VoxelGrid voxels = make_voxels(cells, 0.25f, random_faces(cells, 0.7f, 0.1f, 5));
  const Powers sent = random_powers(voxels.side_count(), 6);
  for (const OrdinateChoice choice : {OrdinateChoice{24, Ordinates::step}, {128, Ordinates::characteristic}}) {
    OrdinatesTransportCpu together(voxels, choice), in_turn(voxels, choice, nullptr, nullptr, {.many_flows = 0});
    EXPECT_LT(in_turn.bytes(), together.bytes());
    Powers a(sent.size(), glm::vec4(0.0f)), b = a;
    for (int order = 0; order < 2; ++order) {  // the second finds nothing left over of the first
      BounceReport report;
      together.carry(sent, a, BounceRules{}, report);
      in_turn.carry(sent, b, BounceRules{}, report);
    }
    EXPECT_EQ(a, b);
    EXPECT_GT(sum(a).x, 0.0);
  }
}

// Of 1024^3 cells, a box's walls: what is not by surfaces is two planes of the most lanes that there are, and a few
// bytes a block of 8^3.
TEST(LargeGridCpu, SweepsKeepAPlane) {
  Grid cube{};
  cube.cells = glm::ivec3(1024);
  const ExpectedSides walls{6u << 20, 6u << 20, 6u << 14};
  const size_t by_surfaces = 84 * walls.sides + (sizeof(sweep::BlockSides) + 1) * walls.blocks;
  const size_t planes = 2 * (size_t(1) << 20) * sweep::kMaxLanes * sizeof(float);
  const size_t blocks = size_t(1) << 21;
  const OrdinateChoice most{128, Ordinates::characteristic};
  EXPECT_LE(OrdinatesTransportCpu::bytes_for(cube, most, walls), by_surfaces + planes + 5 * blocks);
  EXPECT_LE(VoxelGrid::bytes_for(cube, walls.sides, walls.blocks),
            sizeof(shared::Side) * walls.sides + 4300 * walls.blocks + 48 * blocks);
}

/// A hall 64 times as long as it is wide, with a lamp in its middle.
Scene hall() {
  Scene scene;
  add_box_inside(scene, add_material(scene, glm::vec3(0.6f)), glm::vec3(0.0f), {16.0f, 0.25f, 0.25f});
  scene.lights.push_back(point_light(glm::vec3(0.0f), glm::vec3(1.0f)));
  return scene;
}

TEST(LargeGridCpu, TakesWhatItSays) {
  const Scene scene = hall();
  VolumeOptions options;
  options.grid_cells = VolumeOptions::kMaxGridCells;
  VolumeCpu volume(scene, options);
  EXPECT_EQ(volume.grid().cells, glm::ivec3(1024, 16, 16));
  run_with_direct_light(volume, scene);
  EXPECT_TRUE(volume.report().converged);
  const double said = double(bytes_expected_cpu(scene, volume.grid(), options, expected_sides(scene, volume.grid())));
  EXPECT_NEAR(said / double(volume.bytes()), 1.0, 0.1);
  options.memory_limit = volume.bytes() / 2;
  EXPECT_THROW(VolumeCpu(scene, options), Error);
}

// A tilted square of 60 cells across in the last corner of 1024^3: its sides, on either side of it, stand for its area,
// and what is stored is by surfaces.
TEST(LargeGridCpu, LastCornerHasItsSurface) {
  Grid cube = unit_grid(1024);
  Scene scene;
  const glm::vec3 normal = glm::normalize(glm::vec3(0.5f, 0.7f, 0.6f));
  constexpr float HALF = 0.06f;
  add_square(scene, add_material(scene, glm::vec3(0.5f)), glm::vec3(0.93f), normal, HALF);
  add_square(scene, 0, glm::vec3(-0.99f), glm::vec3(0.0f, 1.0f, 0.0f), 0.005f);
  const VoxelGrid voxels = voxelize_cpu(scene, cube);
  double area = 0.0;
  int farthest = 0;
  for (const shared::Side& side : voxels.sides()) {
    const glm::ivec3 cell = shared::cell_coord(cube, side.cell);
    if (cell.x > 512) area += double(side.area_m2);
    farthest = std::max({farthest, cell.x, cell.y, cell.z});
  }
  EXPECT_GT(farthest, 1000);
  EXPECT_NEAR(area / (2.0 * double(4.0f * HALF * HALF)), 1.0, 0.02);
  const ExpectedSides expected = expected_sides(scene, cube);
  EXPECT_NEAR(double(expected.sides) / double(voxels.side_count()), 1.0, 0.1);
  // What is said counts every node of 16^3 leaves that the tree could have, 33 KB each.
  const double said = double(VoxelGrid::bytes_for(cube, expected.sides, expected.blocks));
  EXPECT_GT(said, 0.95 * double(voxels.bytes()));
  EXPECT_LT(said, 1.05 * double(voxels.bytes()) + 512.0 * 36e3);
  EXPECT_LT(voxels.bytes(), 96u << 20);  // of 2^30 cells
}

}  // namespace
}  // namespace volgi::test
