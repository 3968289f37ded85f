#include "voxel/white_pockets.h"

#include <gtest/gtest.h>

#include "shaders/voxel/white_pockets.shared.h"
#include "tests/voxel/white_pocket_scenes.h"
#include "voxel/voxelize_cpu.h"

namespace volgi::test {
namespace {

TEST(WhitePockets, AreWhatNoLightLeaves) {
  for (const PocketScene& of : pocket_scenes()) {
    for (const int cells : {13, 24, 70}) {
      SCOPED_TRACE(of.name + ", " + std::to_string(cells) + " cells");
      const VoxelGrid before = voxelize_cpu(of.scene, make_grid(of.scene, cells, glm::vec3(0.0f)));
      VoxelGrid after = before;
      EXPECT_EQ(bound_white_pockets(after) > 0, of.has_pocket);
      size_t changed = 0;
      for (size_t i = 0; i < before.side_count(); ++i) changed += before.sides()[i].albedo != after.sides()[i].albedo;
      EXPECT_EQ(changed > 0, of.has_pocket);
    }
  }
}

// The body's inside alone, in the bands in which it is white.
TEST(WhitePockets, KeepWhatIsSeen) {
  for (const glm::vec3 albedo : {glm::vec3(1.0f), glm::vec3(1.0f, 0.5f, 0.999f)}) {
    const Scene scene = grey_room_with_a_body(albedo);
    VoxelGrid voxels = voxelize_cpu(scene, make_grid(scene, 24, glm::vec3(0.0f)));
    bound_white_pockets(voxels);
    int inside = 0, outside = 0;
    for (const shared::Side& side : voxels.sides()) {
      const glm::vec3 at =
          shared::world_from_cell(voxels.grid(), glm::vec3(shared::cell_coord(voxels.grid(), side.cell)) + 0.5f);
      const glm::vec3 from_middle = glm::abs(at - glm::vec3(0.1f, 0.3f, -0.2f));
      const bool in_body = from_middle.x < 0.3f && from_middle.y < 0.2f && from_middle.z < 0.25f;
      const bool of_room = std::abs(side.albedo.y - 0.7f) < 1e-3f && std::abs(side.albedo.x - 0.7f) < 1e-3f;
      if (of_room) continue;
      (in_body ? inside : outside)++;
      for (int band = 0; band < 3; ++band) {
        const float expected = in_body && albedo[band] >= WHITE_ALBEDO ? MAX_POCKET_ALBEDO : albedo[band];
        EXPECT_NEAR(side.albedo[band], expected, 1e-4f) << in_body << ' ' << band;
      }
    }
    EXPECT_GT(inside, 50);
    EXPECT_GT(outside, 50);
  }
}

}  // namespace
}  // namespace volgi::test
