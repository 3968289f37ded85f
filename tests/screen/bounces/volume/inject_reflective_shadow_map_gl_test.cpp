// Light in on the GPU against its twin and the cone's closed form, from narrow cones, whose light is a millionth of
// what the same intensity sends in all directions, to half spaces, on coarse and on fine maps.
#include "screen/bounces/volume/inject_reflective_shadow_map.h"

#include <gtest/gtest.h>

#include "core/light.h"
#include "core/visibility/light_flux.h"
#include "propagation/side_flux.h"
#include "tests/support/gl_test.h"
#include "tests/support/volume_scenes.h"
#include "tests/support/voxels.h"

namespace volgi::test {
namespace {

constexpr glm::vec3 kAlbedo{0.7f, 0.2f, 0.05f};
constexpr glm::vec3 kIntensity{5.0f, 1.0f, 0.02f};

struct Injected {
  glm::dvec3 on_sides{0.0};
  glm::vec3 lost{0.0f};
};

class InjectReflectiveShadowMapGl : public GlTest {
 protected:
  static Scene lit_room(float half_angle_deg) {
    Scene scene;
    add_box_inside(scene, add_material(scene, kAlbedo), glm::vec3(0.0f), glm::vec3(0.9f));
    scene.lights.push_back(spot_light({0.11f, 0.6f, 0.07f}, glm::normalize(glm::vec3(0.2f, -1.0f, 0.1f)), 0.0f,
                                      half_angle_deg, kIntensity));
    return scene;
  }
  Injected inject(const Scene& scene, int texels) {
    gl::PassTimer timer(context().software(), false);
    const gl::SceneBuffers buffers(scene);
    screen::ReflectiveShadowMap::Resolution resolution;
    resolution.spot = resolution.cube_face = texels;
    screen::ReflectiveShadowMap maps(resolution);
    maps.run(buffers, scene, timer);
    SlicedVoxelization voxelization(unit_grid(16));
    voxelization.run(buffers, timer);
    SideFluxGl flux;
    flux.begin(voxelization.voxels());
    screen::InjectReflectiveShadowMap().run(voxelization.voxels(), maps, scene, flux, timer);
    Injected r;
    for (glm::vec4 f : flux.punctual().download<glm::vec4>(voxelization.voxels().download_sides().size()))
      r.on_sides += glm::dvec3(f);
    r.lost = flux.lost();
    return r;
  }
  static glm::dvec3 on_the_cpu(const Scene& scene) {
    glm::dvec3 sum(0.0);
    for (const FluxSample& s : light_flux(EmbreeScene(scene), 512)) sum += glm::dvec3(s.flux);
    return sum;
  }
  static void expect_within(const Injected& found, glm::dvec3 expected, double part) {
    EXPECT_EQ(found.lost, glm::vec3(0.0f));
    for (int band = 0; band < 3; ++band) EXPECT_NEAR(found.on_sides[band] / expected[band], 1.0, part) << band;
  }
};

TEST_F(InjectReflectiveShadowMapGl, AsOnTheCpuFromNarrowToWide) {
  for (const float half_angle_deg : {0.25f, 1.0f, 5.0f, 30.0f, 90.0f}) {
    const Scene scene = lit_room(half_angle_deg);
    const glm::dvec3 expected = on_the_cpu(scene);
    for (const int texels : {64, 512, 1024}) {
      SCOPED_TRACE(testing::Message() << half_angle_deg << " degrees, " << texels << " texels");
      expect_within(inject(scene, texels), expected, 1e-3);
    }
  }
}

// Every texel of 4096^2 brings 3e-13 of what the intensity would send in all directions.
TEST_F(InjectReflectiveShadowMapGl, NarrowConeOnALargeMap) {
  const Scene scene = lit_room(0.25f);
  expect_within(inject(scene, 4096), on_the_cpu(scene), 1e-3);
}

// glTF's falloff from the axis to the cone is ((cos - cos outer) * scale)^2, scale = 1/(1 - cos outer), at most 1000:
// its integral is a third of the cone's solid angle where that limit is not met, less below 2.6 degrees.
TEST_F(InjectReflectiveShadowMapGl, AsTheClosedForm) {
  for (const double half_angle_deg : {0.25, 1.0, 5.0, 30.0, 90.0}) {
    const double versine = 2.0 * std::pow(std::sin(0.5 * glm::radians(half_angle_deg)), 2.0);
    const double scale = std::min(1000.0, 1.0 / versine);
    const double solid_angle = 2.0 * M_PI * scale * scale * versine * versine * versine / 3.0;
    const glm::dvec3 expected = solid_angle * glm::dvec3(kIntensity) * glm::dvec3(kAlbedo);
    SCOPED_TRACE(testing::Message() << half_angle_deg << " degrees");
    expect_within(inject(lit_room(float(half_angle_deg)), 512), expected, 1e-3);
  }
}

}  // namespace
}  // namespace volgi::test
