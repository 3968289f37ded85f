// Virtual lights of rays against those of reflective shadow maps: the same samples of the same lights.
#include "core/visibility/virtual_lights_cpu.h"

#include <filesystem>

#include "tests/screen/virtual_light_scenes.h"
#include "tests/support/gl_test.h"
#include "tests/support/paths.h"

namespace volgi::test {
namespace {

using VirtualLightTwins = GlTest;

constexpr int kCount = 2048;

struct Agreement {
  double share;       // of lights that agree
  glm::dvec3 energy;  // of all: rays over maps
};

Agreement agreement(const gl::Context& context, const Scene& scene) {
  gl::PassTimer timer(context.software(), false);
  const gl::SceneBuffers buffers(scene);
  screen::ReflectiveShadowMap maps;
  maps.run(buffers, scene, timer);
  screen::VirtualLights pass(scene, {kCount, {}, Sampling::halton});
  pass.run(maps, nullptr, timer);
  const std::vector<VirtualLight> of_maps = pass.download().lights;
  const VirtualLightsCpu of_rays = virtual_lights_cpu(EmbreeScene(scene), EmitterPoints(scene), kCount);
  EXPECT_EQ(of_rays.reflected, pass.reflected());
  EXPECT_EQ(of_rays.emitted(), pass.emitted());
  const float size = glm::distance(scene.bounds_min, scene.bounds_max);
  int agree = 0;
  for (size_t i = 0; i < std::min(of_maps.size(), of_rays.lights.size()); ++i) {
    const VirtualLight& m = of_maps[i];
    const VirtualLight& r = of_rays.lights[i];
    EXPECT_EQ(m.source, r.source);
    EXPECT_EQ(m.kind, r.kind);
    const bool dark = m.flux == glm::vec3(0.0f) && r.flux == glm::vec3(0.0f);
    const glm::vec3 flux = glm::abs(m.flux - r.flux);
    const bool alike = glm::distance(m.position, r.position) < 1e-3f * size &&
                       glm::all(glm::lessThanEqual(flux, 0.01f * r.flux)) && glm::dot(m.normal, r.normal) > 0.999f &&
                       std::abs(m.area_m2 - r.area_m2) < 0.02f * r.area_m2;
    agree += int(dark || alike);
  }
  return {double(agree) / double(of_rays.lights.size()), sum_of_flux(of_rays.lights) / sum_of_flux(of_maps)};
}

void expect_alike(const gl::Context& context, const Scene& scene) {
  const Agreement a = agreement(context, scene);
  ::testing::Test::RecordProperty("agree_percent", std::to_string(100.0 * a.share));
  ::testing::Test::RecordProperty(
      "energy", std::to_string(a.energy.x) + ' ' + std::to_string(a.energy.y) + ' ' + std::to_string(a.energy.z));
  EXPECT_GE(a.share, 0.97);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(a.energy[c], 1.0, 0.01);
}

Scene file(const char* name) { return load_scene(source_dir() / "data" / (std::string(name) + ".glb")); }

TEST_F(VirtualLightTwins, Cornell) { expect_alike(context(), file("cornell")); }
TEST_F(VirtualLightTwins, Room) { expect_alike(context(), file("room")); }
TEST_F(VirtualLightTwins, ThinWall) { expect_alike(context(), file("thin_wall")); }

TEST_F(VirtualLightTwins, PointSunSpotAndEmitter) {
  Scene scene = stage();
  const int lamp = add_material(scene, glm::vec3(0.1f));
  scene.materials[size_t(lamp)].emissive_radiance = glm::vec3(4, 3, 2);
  add_quad(scene, lamp, {-0.25f, 1.5f, -0.25f}, {0.5f, 0, 0}, {0, 0, 0.5f});
  update_bounds(scene);
  scene.lights = one_of_each();
  for (Light& light : scene.lights) light.position = {0.9f, 2.5f, 2.2f};
  scene.lights[2].range_m = 5.0f;
  expect_alike(context(), scene);
}

// A spot that points straight up, and one along an axis.
TEST_F(VirtualLightTwins, SpotsMayPointAnywhere) {
  Scene scene = colourful_room();
  scene.lights = {spot_light(kLamp, {0, 1, 0}, 0, 30, 1.0f), spot_light(kLamp, {0, -1, 0}, 10, 30, 1.0f),
                  spot_light(kLamp, {-1, 0, 0}, 40, 80, 1.0f), point_light(kLamp, 0.3f)};
  expect_alike(context(), scene);
}

}  // namespace
}  // namespace volgi::test
