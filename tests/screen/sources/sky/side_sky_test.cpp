// Sky light on a volume's sides: maps against rays.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "core/sky.h"
#include "propagation/light_in/side_sky_cpu.h"
#include "screen/sources/sky/side_sky_gl.h"
#include "tests/support/gl_test.h"
#include "tests/support/volume_scenes.h"
#include "voxel/grid.h"
#include "voxel/voxelize_cpu.h"

namespace volgi {
namespace {

using SideSky = test::GlTest;

Scene walled_yard() {
  Scene scene;
  const int paint = test::add_material(scene, glm::vec3(0.5f, 0.6f, 0.7f));
  test::add_quad(scene, paint, {-2, 0, 2}, {4, 0, 0}, {0, 0, -4});
  test::add_quad(scene, paint, {-2, 0, -2}, {4, 0, 0}, {0, 1.5f, 0});
  test::add_quad(scene, paint, {-2, 0, 2}, {0, 0, -4}, {0, 1.5f, 0});
  test::add_quad(scene, paint, {-2, 1.5f, 0}, {2, 0, 0}, {0, 0, -2});  // a roof over one corner
  scene.sky = std::make_shared<Sky>(glm::vec3(1.0f, 2.0f, 3.0f));
  return scene;
}

TEST_F(SideSky, MapsAgreeWithRays) {
  const Scene scene = walled_yard();
  const Grid grid = make_grid(scene, 16);
  const VoxelGrid voxels = voxelize_cpu(scene, grid, voxelization_mipmaps(scene));
  const gl::SceneBuffers buffers(scene);
  gl::PassTimer timer(context().software(), false);
  screen::SkyOptions options;
  options.map_texels = 256;
  screen::SkyMaps maps(options);
  maps.run(buffers, scene, timer);
  SideSkyCpu rays;
  const EmbreeScene embree(scene);
  const auto& expected = rays.irradiance(voxels, embree, maps.parts(), maps.version());

  VoxelGridGl uploaded;
  upload(voxels, uploaded);
  SideFluxGl flux;
  flux.begin(uploaded);
  screen::SideSkyGl pass;
  pass.run(uploaded, maps, flux, timer);
  const auto found = flux.emitted().download<glm::vec4>(voxels.side_count());
  double difference = 0.0, sum = 0.0;
  for (size_t s = 0; s < voxels.side_count(); ++s) {
    const shared::Side& side = voxels.sides()[s];
    const double e = double(found[s].y / (side.albedo.y * side.area_m2));
    difference += std::pow(e - double(expected[s].y), 2.0);
    sum += double(expected[s].y);
    EXPECT_NEAR(found[s].x / side.albedo.x, 0.5f * found[s].y / side.albedo.y, 1e-4f) << s;
  }
  const double mean = sum / double(voxels.side_count());
  const double rms = std::sqrt(difference / double(voxels.side_count())) / mean;
  RecordProperty("rms_percent", std::to_string(100.0 * rms));
  EXPECT_LT(rms, 0.12);
  EXPECT_GT(mean, 0.3 * 2.0 * 3.14159);
}

// What was found is kept while nothing changes, and looked at again when something does.
TEST_F(SideSky, RaysAreCastAgainForOtherParts) {
  Scene scene = walled_yard();
  const VoxelGrid voxels = voxelize_cpu(scene, make_grid(scene, 8), voxelization_mipmaps(scene));
  const EmbreeScene embree(scene);
  SideSkyCpu rays;
  const auto parts = sky_lights(*scene.sky, 128);
  const std::vector<glm::vec4> first = rays.irradiance(voxels, embree, parts, 1);
  EXPECT_EQ(rays.irradiance(voxels, embree, {}, 1), first) << "kept";
  const auto brighter = sky_lights(Sky(glm::vec3(2.0f, 4.0f, 6.0f)), 128);
  const std::vector<glm::vec4>& second = rays.irradiance(voxels, embree, brighter, 2);
  for (size_t s = 0; s < first.size(); ++s) EXPECT_NEAR(second[s].x, 2.0f * first[s].x, 1e-4f);
}

}  // namespace
}  // namespace volgi
