// What pixels read from a volume's sides, on the GPU and on the CPU.
#include "screen/bounces/volume/volume_gather.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/camera.h"
#include "core/gl/scene_buffers.h"
#include "tests/support/gl_test.h"
#include "tests/support/volume_scenes.h"
#include "voxel/voxelize_cpu.h"

namespace volgi::test {
namespace {

/// Two rooms that a thin wall parts, with a tilted board and a thin rod in one.
Scene rooms() {
  Scene scene;
  const int grey = add_material(scene, glm::vec3(0.7f, 0.5f, 0.3f));
  add_box_inside(scene, grey, glm::vec3(0.0f), {1.0f, 0.6f, 0.8f});
  add_quad(scene, grey, {0.1f, -0.6f, -0.8f}, {0.0f, 1.2f, 0.0f}, {0.0f, 0.0f, 1.2f});
  add_square(scene, grey, {-0.4f, 0.0f, 0.1f}, {0.3f, 1.0f, 0.5f}, 0.3f);
  add_box(scene, grey, {-0.2f, 0.2f, -0.2f}, {0.3f, 0.01f, 0.01f});
  return scene;
}

using VolumeGatherGl = GlTest;

// Twins: a pixel differs by rounding alone, unless a comparison falls the other way (normals of 16 bits, planes that a
// point lies on): 0.2 % of the pixels may.
TEST_F(VolumeGatherGl, ReadsAsTheCpuDoes) {
  const Scene scene = rooms();
  const glm::ivec2 size(96, 96);
  const Camera camera =
      look_at_camera({-0.9f, 0.3f, 0.7f}, {0.2f, -0.1f, -0.3f}, 1.2f, scene.bounds_min, scene.bounds_max);
  gl::PassTimer timer(context().software(), false);
  screen::GBuffer gbuffer(size);
  gbuffer.run(gl::SceneBuffers(scene), camera, timer);
  for (const int cells : {9, 30}) {
    const VoxelGrid voxels = voxelize_cpu(scene, make_grid(scene, cells));
    SideIrradiance values;
    for (size_t i = 0; i < voxels.side_count(); ++i) {
      values.direct.emplace_back(1.0f + float(i % 13));
      values.indirect.emplace_back(1.0f + float(i % 97));
    }
    const gl::Buffer direct(values.direct), indirect(values.indirect);
    screen::VolumeGather on_gpu(size), on_cpu(size);
    on_gpu.run(gbuffer, camera, {upload(voxels), direct, indirect, true}, nullptr, timer);
    on_cpu.run_on_cpu(gbuffer, camera, voxels, std::span(&values, 1), nullptr, timer);
    for (const auto picture : {&screen::VolumeGather::direct, &screen::VolumeGather::indirect}) {
      const std::vector<float> a = (on_gpu.*picture)().download(3), b = (on_cpu.*picture)().download(3);
      ASSERT_EQ(a.size(), b.size());
      const float largest = *std::max_element(a.begin(), a.end());
      EXPECT_GT(largest, 0.0f);
      size_t others = 0;
      for (size_t i = 0; i < a.size(); ++i) others += std::abs(a[i] - b[i]) > 1e-4f * largest;
      EXPECT_LT(double(others), 0.002 * double(a.size())) << cells;
    }
  }
}

}  // namespace
}  // namespace volgi::test
