// Light in: the flux of emitters is on sides, all of it, on the sides that face as they do.
#include "propagation/side_flux_gl.h"

#include <gtest/gtest.h>

#include "propagation/side_flux.h"
#include "tests/support/gl_test.h"
#include "tests/support/volume_scenes.h"
#include "tests/support/voxels.h"
#include "voxel/emitter_pieces.h"

namespace volgi::test {
namespace {

class SideFluxGlTest : public GlTest {
 protected:
  struct Result {
    Voxels voxels;
    std::vector<glm::vec4> emitted;
    glm::vec3 lost;
  };
  Result inject(const Scene& scene, const Grid& grid) {
    gl::PassTimer timer(context().software(), false);
    SlicedVoxelization voxelization(grid);
    Result r{voxelize(context(), voxelization, scene), {}, {}};
    SideFluxGl flux;
    flux.begin(voxelization.voxels());
    flux.inject_emitters(voxelization.voxels(), emitter_pieces(scene, grid), timer);
    r.emitted = flux.emitted().download<glm::vec4>(r.voxels.sides.size());
    r.lost = flux.lost();
    return r;
  }
};

TEST_F(SideFluxGlTest, SumsExactlyAndFacesTheRightWay) {
  for (glm::vec3 normal : {glm::vec3(0, -1, 0), glm::vec3(1, 1, 0), glm::vec3(-0.3f, 0.8f, 0.5f)}) {
    for (float intensity : {1e-6f, 1.0f, 1e9f}) {
      Scene scene;
      const glm::vec3 radiance = intensity * glm::vec3(3.0f, 1.0f, 0.0f);
      add_square(scene, add_material(scene, glm::vec3(0.5f), radiance), {0.05f, -0.1f, 0.02f}, normal, 0.5f);
      const Result r = inject(scene, unit_grid(16));
      glm::dvec3 sum(0.0);
      for (size_t i = 0; i < r.emitted.size(); ++i) {
        sum += glm::dvec3(r.emitted[i]);
        if (r.emitted[i].x > 0.0f) {
          EXPECT_GT(glm::dot(r.voxels.sides[i].normal, glm::normalize(normal)), 0.99f);
        }
      }
      EXPECT_NEAR(sum.x / (glm::pi<double>() * double(radiance.x)), 1.0, 1e-5);
      EXPECT_NEAR(sum.y / (glm::pi<double>() * double(radiance.y)), 1.0, 1e-5);
      EXPECT_EQ(sum.z, 0.0);
      EXPECT_EQ(r.lost, glm::vec3(0.0f));
    }
  }
}

// An emitter too small to block a face sends through its neighbours' sides; all of it while there are any.
TEST_F(SideFluxGlTest, EmitterTooSmallForTheGrid) {
  Scene scene;
  add_box_inside(scene, add_material(scene, glm::vec3(0.5f)), glm::vec3(0.0f), glm::vec3(1.0f));
  add_square(scene, add_material(scene, glm::vec3(0.0f), glm::vec3(100.0f)), {0.01f, 0.97f, 0.01f}, {0.0f, -1.0f, 0.0f},
             0.02f);
  const Result r = inject(scene, unit_grid(8));
  double sum = 0.0;
  for (size_t i = 0; i < r.emitted.size(); ++i) {
    sum += double(r.emitted[i].x);
    if (r.emitted[i].x > 0.0f) {
      EXPECT_LT(r.voxels.sides[i].normal.y, -0.9f);
    }
  }
  EXPECT_NEAR(sum / (glm::pi<double>() * 100.0 * 0.0016), 1.0, 1e-5);
  EXPECT_EQ(r.lost, glm::vec3(0.0f));
}

// Alone in the void it has nowhere to send: the report says how much.
TEST_F(SideFluxGlTest, WhatFindsNoSideIsReported) {
  Scene scene;
  add_square(scene, add_material(scene, glm::vec3(0.0f), glm::vec3(100.0f)), {0.01f, 0.02f, 0.01f}, {0.0f, -1.0f, 0.0f},
             0.005f);
  const Result r = inject(scene, unit_grid(8));
  EXPECT_TRUE(r.voxels.sides.empty());
  EXPECT_NEAR(r.lost.x / (glm::pi<float>() * 100.0f * 1e-4f), 1.0f, 1e-5f);
}

// Radiosity of sides and injected flux are two roads to the same power.
TEST_F(SideFluxGlTest, FluxIsAreaTimesRadiosity) {
  Scene scene;
  add_sphere_inside(scene, add_material(scene, glm::vec3(0.5f), glm::vec3(1.0f)), glm::vec3(0.0f), 0.8f, 16);
  const Result r = inject(scene, unit_grid(16));
  double flux = 0.0, sides = 0.0;
  for (size_t i = 0; i < r.emitted.size(); ++i) {
    flux += double(r.emitted[i].x);
    sides += double(r.voxels.sides[i].area_m2 * r.voxels.sides[i].radiosity.x);
  }
  EXPECT_NEAR(sides / flux, 1.0, 0.012);
}

// The twin on the CPU puts every sample where the GPU does.
TEST_F(SideFluxGlTest, AsOnTheCpu) {
  Scene scene;
  add_sphere_inside(scene, add_material(scene, glm::vec3(0.5f), glm::vec3(3.0f, 1.0f, 0.2f)), glm::vec3(0.0f), 0.8f,
                    16);
  add_square(scene, add_material(scene, glm::vec3(0.5f), glm::vec3(9.0f)), {0.1f, 0.05f, 0.0f}, {1, 2, 3}, 0.3f);
  add_square(scene, add_material(scene, glm::vec3(0.5f), glm::vec3(9.0f)), {0.0f, 0.98f, 0.9f}, {0, 1, 0}, 0.01f);
  // A thin body, one face of it through the centres of cells.
  add_box_inside(scene, add_material(scene, glm::vec3(0.5f), glm::vec3(7.0f)), {0.25f, -0.1833333f, 0.2f},
                 {-0.1f, -0.0666667f, -0.1f});
  const Result r = inject(scene, unit_grid(12));
  const VoxelGrid voxels(r.voxels.grid, r.voxels.sides);
  std::vector<glm::vec4> flux(voxels.side_count(), glm::vec4(0.0f));
  glm::vec3 lost(0.0f);
  deposit(voxels, emitter_pieces(scene, unit_grid(12)), flux, lost);
  glm::dvec3 off(0.0), all(0.0);
  for (size_t i = 0; i < flux.size(); ++i) {
    off += glm::abs(glm::dvec3(flux[i]) - glm::dvec3(r.emitted[i]));
    all += glm::dvec3(flux[i]);
  }
  for (int band = 0; band < 3; ++band) {
    EXPECT_LE(off[band], 1e-5 * all[band]);
    EXPECT_NEAR(lost[band], r.lost[band], 1e-5 * all[band]);
  }
}

}  // namespace
}  // namespace volgi::test
