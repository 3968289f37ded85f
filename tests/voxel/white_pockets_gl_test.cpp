#include "voxel/white_pockets_gl.h"

#include "core/gl/scene_buffers.h"
#include "tests/support/gl_test.h"
#include "tests/voxel/white_pocket_scenes.h"
#include "voxel/voxelize_cpu.h"
#include "voxel/white_pockets.h"

namespace volgi::test {
namespace {

using WhitePocketsGlTest = GlTest;

TEST_F(WhitePocketsGlTest, AreThoseOfTheCpu) {
  for (const PocketScene& of : pocket_scenes()) {
    SCOPED_TRACE(of.name);
    VoxelGrid cpu = voxelize_cpu(of.scene, make_grid(of.scene, 22, glm::vec3(0.0f)));
    const VoxelGridGl gpu = upload(cpu);
    gl::PassTimer timer(context().software(), false);
    WhitePocketsGl pockets;
    pockets.run(gpu, timer);
    EXPECT_EQ(pockets.cells(), bound_white_pockets(cpu));
    const auto sides = gpu.download_sides();
    ASSERT_GE(sides.size(), cpu.side_count());
    for (size_t i = 0; i < cpu.side_count(); ++i) ASSERT_EQ(sides[i].albedo, cpu.sides()[i].albedo) << i;
  }
}

}  // namespace
}  // namespace volgi::test
