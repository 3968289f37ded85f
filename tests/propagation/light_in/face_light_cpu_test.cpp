// The light of lamps that meets the grid's own faces in place of triangles.
#include "propagation/light_in/face_light_cpu.h"

#include <gtest/gtest.h>

#include <glm/gtc/constants.hpp>
#include <mutex>
#include <random>

#include "core/ranks_in_threads.h"
#include "propagation/light_in/direct_light_cpu.h"
#include "tests/propagation/synthetic_voxels.h"
#include "tests/support/volume_scenes.h"
#include "voxel/grid_faces.h"
#include "voxel/voxelize_cpu.h"

namespace volgi::test {
namespace {

/// Cell by cell in double precision, and blocks without sides like all others.
bool meet_slowly(const VoxelGrid& voxels, glm::dvec3 origin, glm::dvec3 direction, GridFaces::Hit& hit) {
  glm::ivec3 cell(glm::floor(origin));
  while (shared::cell_inside(voxels.grid(), cell)) {
    int axis = 0;
    double t = 1e300;
    for (int a = 0; a < 3; ++a) {
      const double at = (double(cell[a]) + (direction[a] > 0.0 ? 1.0 : 0.0) - origin[a]) / direction[a];
      if (at < t) t = at, axis = a;
    }
    const int face = 2 * axis + (direction[axis] > 0.0 ? 1 : 0);
    if (shared::has_side(voxels.cell_sides(cell), face)) {
      hit = {cell, face, float(t)};
      return true;
    }
    cell += shared::face_step(face);
  }
  return false;
}

struct Rays {
  std::vector<glm::vec3> origins, directions;
  Rays(glm::ivec3 cells, size_t count) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
    for (size_t i = 0; i < count; ++i) {
      origins.push_back(glm::vec3(cells) * glm::vec3(uniform(random), uniform(random), uniform(random)));
      directions.push_back(glm::normalize(glm::vec3(uniform(random), uniform(random), uniform(random)) - 0.5f));
    }
  }
};

// The first face on the way, through blocks with sides and without, up and down all axes.
TEST(GridFaces, MeetsWhatIsFirst) {
  const glm::ivec3 cells(50, 29, 41);
  const Coverage few = random_faces(cells, 0.9f, 0.002f, 3);
  const VoxelGrid voxels =
      make_voxels(cells, 0.1f, [&](int axis, glm::ivec3 c) { return few(axis, c) > 0.0f ? 1.0f : 0.0f; });
  const GridFaces faces(voxels);
  const Rays rays(cells, 20000);
  size_t met = 0, other = 0;
  for (size_t i = 0; i < rays.origins.size(); ++i) {
    GridFaces::Hit fast, slow;
    const bool a = faces.meet(rays.origins[i], rays.directions[i], 0, fast);
    const bool b = meet_slowly(voxels, rays.origins[i], rays.directions[i], slow);
    met += b;
    other += a != b || (b && (fast.cell != slow.cell || fast.face != slow.face));
  }
  EXPECT_GT(met, rays.origins.size() / 2);
  EXPECT_LT(met, rays.origins.size());
  EXPECT_LE(other, 4u);  // that pass within a rounding of an edge
}

// From outside into the grid, but not through a wall on its rim; and what lies beside it is never met.
TEST(GridFaces, RaysFromOutside) {
  const glm::ivec3 cells(10, 12, 9);
  const VoxelGrid voxels = make_voxels(cells, 0.1f, [](int axis, glm::ivec3 c) {
    return axis == 0 && (c.x == 10 || (c.x == 0 && c.y < 6)) ? 1.0f : 0.0f;
  });
  const GridFaces faces(voxels);
  GridFaces::Hit hit;
  ASSERT_TRUE(faces.meet({-5.0f, 7.5f, 4.5f}, {1.0f, 0.0f, 0.0f}, 0, hit));
  EXPECT_EQ(hit.cell, glm::ivec3(9, 7, 4));
  EXPECT_EQ(hit.face, 1);
  EXPECT_FLOAT_EQ(hit.t, 15.0f);
  EXPECT_FALSE(faces.meet({-5.0f, 3.5f, 4.5f}, {1.0f, 0.0f, 0.0f}, 0, hit));
  EXPECT_FALSE(faces.meet({-5.0f, 7.5f, 4.5f}, {-1.0f, 0.0f, 0.0f}, 0, hit));
  EXPECT_FALSE(faces.meet({-5.0f, 13.0f, 4.5f}, {1.0f, 0.0f, 0.0f}, 0, hit));
  EXPECT_FALSE(faces.meet({-5.0f, 11.0f, 4.5f}, glm::normalize(glm::vec3(1.0f, 1.0f, 0.0f)), 0, hit));
}

// A sheet that stops a share of the light stops that share of rays: of n, within four standard deviations.
TEST(GridFaces, PartsStopTheirShare) {
  const glm::ivec3 cells(16);
  for (const float tau : {0.1f, 0.5f, 0.9f}) {
    const VoxelGrid voxels =
        make_voxels(cells, 0.1f, [&](int axis, glm::ivec3 c) { return axis == 0 && c.x == 8 ? tau : 0.0f; });
    const GridFaces faces(voxels);
    constexpr int kRays = 20000;
    int stopped = 0;
    for (int i = 0; i < kRays; ++i) {
      GridFaces::Hit hit;
      const glm::vec3 from(1.0f, 0.01f + float(i % 150) / 10.0f, 0.01f + float(i / 150) / 10.0f);
      stopped += faces.meet(from, {1.0f, 0.0f, 0.0f}, std::uint32_t(i), hit);
    }
    EXPECT_NEAR(double(stopped) / kRays, double(tau), 4.0 * std::sqrt(0.25 / kRays) + 0.5 / 255.0);
  }
}

Scene lit_box(const glm::mat3& turned) {
  Scene scene;
  add_box_inside(scene, add_material(scene, glm::vec3(0.8f, 0.5f, 0.2f)), glm::vec3(0.0f), glm::vec3(1.0f), turned);
  Light lamp;
  lamp.type = Light::Type::point;
  lamp.intensity = glm::vec3(3.0f, 2.0f, 1.0f);
  lamp.position = turned * glm::vec3(0.1f, -0.05f, 0.03f);
  scene.lights.push_back(lamp);
  update_bounds(scene);
  return scene;
}

glm::dvec3 total(const std::vector<FluxSample>& samples) {
  glm::dvec3 sum(0.0);
  for (const FluxSample& s : samples) sum += glm::dvec3(s.flux);
  return sum;
}

// All of a lamp's light falls on a closed box around it, also where the box is a staircase: 4 pi I, times the albedo.
TEST(FaceLight, PowerOfALampInABox) {
  for (const bool turned : {false, true}) {
    const glm::mat3 turn(turned ? glm::rotate(glm::mat4(1.0f), 0.4f, glm::vec3(1.0f, 2.0f, 3.0f)) : glm::mat4(1.0f));
    const Scene scene = lit_box(turn);
    const Grid grid = make_grid(scene, 40);
    const VoxelGrid voxels = voxelize_cpu(scene, grid);
    const glm::dvec3 expected = 4.0 * glm::pi<double>() * glm::dvec3(3.0, 2.0, 1.0) * glm::dvec3(0.8, 0.5, 0.2);
    const glm::dvec3 found = total(face_light(scene, voxels, 128));
    for (int band = 0; band < 3; ++band) EXPECT_NEAR(found[band] / expected[band], 1.0, 1e-3) << turned;
    // As rays have it, wall by wall, within what a cell's width on the way of a wall's edge is: samples by where they
    // lie.
    const SideFlux rays = DirectLightCpu(scene, true).flux(voxels), faces = DirectLightCpu(scene, false).flux(voxels);
    EXPECT_LT(std::abs(faces.lost.x), 1e-3 * expected.x);
    std::array<double, 6> by_wall_rays{}, by_wall_faces{};
    for (size_t i = 0; i < voxels.side_count(); ++i) {
      const glm::vec3 n = glm::transpose(turn) * voxels.sides()[i].normal;
      const int axis = std::abs(n.x) > 0.7f ? 0 : std::abs(n.y) > 0.7f ? 1 : 2;
      const auto wall = size_t(2 * axis + (n[axis] > 0.0f));
      by_wall_rays[wall] += double(rays.punctual[i].x);
      by_wall_faces[wall] += double(faces.punctual[i].x);
    }
    for (size_t wall = 0; wall < 6; ++wall)
      EXPECT_NEAR(by_wall_faces[wall] / by_wall_rays[wall], 1.0, turned ? 0.05 : 0.002) << turned << wall;
  }
}

// Ranks meet the same faces, with what each has of them on all.
TEST(FaceLight, RanksFindTheSame) {
  const Scene scene = lit_box(glm::mat3(glm::rotate(glm::mat4(1.0f), 0.4f, glm::vec3(1.0f, 2.0f, 3.0f))));
  const Grid grid = make_grid(scene, 40);
  const std::vector<FluxSample> one = face_light(scene, voxelize_cpu(scene, grid), 64);
  std::vector<NumberedFluxSample> many;
  std::mutex mutex;
  run_ranks_in_threads(3, [&](const Ranks& ranks) {
    const RanksOfVolume of{ranks, Decomposition(leaf_blocks(grid), 3)};
    const VoxelGrid voxels = voxelize_cpu(scene, grid, voxelization_mipmaps(scene), of);
    const auto found = face_light(scene, voxels, of, 64);
    const std::lock_guard lock(mutex);
    many.insert(many.end(), found.begin(), found.end());
  });
  std::sort(many.begin(), many.end(), [](const auto& a, const auto& b) { return a.number < b.number; });
  ASSERT_EQ(one.size(), many.size());
  size_t differ = 0;
  for (size_t i = 0; i < one.size(); ++i) differ += std::memcmp(&one[i], &many[i].sample, sizeof one[i]) != 0;
  EXPECT_EQ(differ, 0u);
}

}  // namespace
}  // namespace volgi::test
