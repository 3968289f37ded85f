// Sky light that streams in at the rim of a grid.
#include "propagation/rim_inflow.h"

#include <gtest/gtest.h>
#include <openvdb/openvdb.h>

#include <cmath>
#include <glm/gtc/constants.hpp>
#include <memory>

#include "propagation/light_in/direct_light_cpu.h"
#include "propagation/volume_cpu.h"
#include "tests/support/volume_scenes.h"

namespace volgi {
namespace {

TEST(RimInflow, ConstantSkySendsPiLThroughEveryFace) {
  const Sky sky(glm::vec3(1.0f, 2.0f, 3.0f));
  for (const int directions : {8, 24, 48, 80, 128}) {
    const OrdinateSet set = ordinate_set(directions);
    const std::vector<glm::vec3> flux = rim_inflow(sky, set);
    const size_t n = set.directions.size();
    ASSERT_EQ(flux.size(), 8 * n);
    for (int axis = 0; axis < 3; ++axis) {
      double power = 0.0;  // of the four octants that go up the axis
      for (size_t k = 0; k < flux.size(); ++k) {
        if (((k / n) >> axis & 1u) == 0) continue;
        power += double(inflow_per_flux(set, k % n, 0.5f)[axis] * flux[k].y);
      }
      EXPECT_NEAR(power, glm::pi<double>() * 2.0 * 0.25, 1e-5) << directions;
    }
  }
}

TEST(RimInflow, LightKeepsItsSide) {
  Image picture(64, 32);
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 64; ++x) picture.at(x, y) = glm::vec3(1.0f);
  const std::vector<glm::vec3> flux = rim_inflow(Sky(picture), ordinate_set(24));
  double up = 0.0, down = 0.0;
  // Half a texel of it is below the horizon, between the two rows of texels there.
  for (size_t k = 0; k < flux.size(); ++k) {
    const bool goes_up = (k / 3 >> 1 & 1u) != 0;
    (goes_up ? up : down) += double(flux[k].x);
  }
  EXPECT_GT(down, 6.0);
  EXPECT_LT(up, 0.1 * down);
}

class StreamingSky : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Directions, StreamingSky, testing::Values(8, 24, 48, 128));

VolumeOptions options_of(int directions) {
  VolumeOptions o;
  o.grid_cells = 12;
  o.scheme.directions = directions;
  return o;
}

// A black floor under an open sky: every side receives pi L h^2.
TEST_P(StreamingSky, OpenFloorReceivesAllOfIt) {
  Scene scene;
  test::add_quad(scene, test::add_material(scene, glm::vec3(0.0f)), {-1, 0, 1}, {2, 0, 0}, {0, 0, -2});
  scene.bounds_max.y = 0.9f;  // cells above
  scene.sky = std::make_shared<Sky>(glm::vec3(2.0f));
  VolumeCpu volume(scene, options_of(GetParam()));
  run_with_direct_light(volume, scene);
  ASSERT_GT(volume.voxels().side_count(), 100u);
  for (const glm::vec4& e : volume.irradiance().direct) EXPECT_NEAR(e.x, glm::two_pi<float>(), 0.002f);
}

// Free space is as bright as the sky around it: 4 pi L.
TEST_P(StreamingSky, FreeSpaceHasItsFluence) {
  Scene scene;
  test::add_quad(scene, test::add_material(scene, glm::vec3(0.0f)), {-0.01f, 0, 0.01f}, {0.02f, 0, 0}, {0, 0, -0.02f});
  scene.bounds_min = {-1.0f, 0.0f, -1.0f};
  scene.bounds_max = {1.0f, 2.0f, 1.0f};
  scene.sky = std::make_shared<Sky>(glm::vec3(2.0f));
  VolumeCpu volume(scene, options_of(GetParam()));
  run_with_direct_light(volume, scene);
  const auto all = openvdb::gridPtrCast<openvdb::Vec3SGrid>(fluence(volume.radiance()));
  for (const openvdb::Coord cell : {openvdb::Coord(0, 0, 0), {3, 9, 11}, {6, 11, 2}})
    EXPECT_NEAR(all->tree().getValue(cell).x(), 8.0f * glm::pi<float>(), 0.01f);
}

// A furnace: whatever its albedo and form, a body under the same radiance everywhere has that radiance times albedo.
TEST_P(StreamingSky, ConvexBodyInAFurnace) {
  Scene scene;
  const int paint = test::add_material(scene, glm::vec3(0.6f));
  for (int axis = 0; axis < 3; ++axis) {
    for (const float side : {-1.0f, 1.0f}) {
      glm::vec3 n(0.0f);
      n[axis] = side;
      test::add_square(scene, paint, 0.5f * n, n, 0.5f);
    }
  }
  scene.bounds_min = glm::vec3(-1.5f);
  scene.bounds_max = glm::vec3(1.5f);
  scene.sky = std::make_shared<Sky>(glm::vec3(1.0f));
  VolumeCpu volume(scene, options_of(GetParam()));
  run_with_direct_light(volume, scene);
  int outside = 0;
  for (size_t s = 0; s < volume.voxels().side_count(); ++s) {
    if (volume.voxels().sides()[s].front == 0) continue;
    const glm::vec4 e = volume.irradiance().direct[s] + volume.irradiance().indirect[s];
    EXPECT_NEAR(e.x, glm::pi<float>(), 0.005f * glm::pi<float>());
    ++outside;
  }
  EXPECT_GT(outside, 90);
}

}  // namespace
}  // namespace volgi
