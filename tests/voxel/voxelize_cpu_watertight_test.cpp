// What is closed in the scene is closed in the CPU's volume.
#include <gtest/gtest.h>

#include "tests/support/volume_scenes.h"
#include "tests/voxel/cpu_voxels.h"
#include "voxel/voxelize_cpu.h"

namespace volgi::test {
namespace {

// Planes seen from in front have no fringe of partly covered faces, whatever their tilt: coverage is 1, or no side.
TEST(VoxelizeCpu, TiltedPlanesStopEverythingOrNothing) {
  Random random;
  int sides = 0;
  for (int i = 0; i < 60; ++i) {
    const glm::vec3 normal = i == 0 ? glm::vec3(1, 1, 1) : i == 1 ? glm::vec3(1, 1, 0) : random.vec();
    Scene scene;
    add_square(scene, add_material(scene, kRed), 0.2f * random.vec(), normal, 4.0f);
    const VoxelGrid v = voxelize_cpu(scene, unit_grid(16));
    sides += int(v.side_count());
    for (const Side& side : v.sides()) {
      // Where the grid ends, what is outside counts as one space: scenes do not reach there, this plane does.
      const glm::ivec3 next = shared::cell_coord(v.grid(), side.cell) + shared::face_step(side.face);
      if (!shared::cell_inside(v.grid(), next)) continue;
      EXPECT_EQ(side.coverage, 1.0f) << "plane " << i;
    }
  }
  EXPECT_GT(sides, 60 * 2 * 256);
}

// And cells on different sides of a plane are always told apart: exactly the faces between them are blocked.
TEST(VoxelizeCpu, TiltedPlanesSeparateCells) {
  Random random;
  for (int i = 0; i < 40; ++i) {
    const glm::vec3 normal = glm::normalize(random.vec());
    const glm::vec3 on_plane = 0.2f * random.vec();
    Scene scene;
    add_square(scene, add_material(scene, kRed), on_plane, normal, 4.0f);
    const VoxelGrid v = voxelize_cpu(scene, unit_grid(12));
    const auto distance = [&](glm::ivec3 c) {
      return glm::dot(shared::world_from_cell(v.grid(), glm::vec3(c) + 0.5f) - on_plane, normal);
    };
    for (int k = 0; k < int(cell_count(v.grid())); ++k) {
      const glm::ivec3 c = shared::cell_coord(v.grid(), k);
      for (int face = 0; face < 6; ++face) {
        if (!shared::cell_inside(v.grid(), c + shared::face_step(face))) continue;
        const float here = distance(c), there = distance(c + shared::face_step(face));
        const float rounding = 2.0f * v.grid().cell_size_m / 384.0f;
        if (std::min(std::abs(here), std::abs(there)) < rounding) continue;
        EXPECT_EQ(shared::is_opaque(v.cell_sides(c), face), here * there < 0.0f) << "plane " << i;
      }
    }
  }
}

// Sheets through cell centres, their triangles wound differently: ties are broken for all families alike.
TEST(VoxelizeCpu, SheetsThroughCentresDoNotLeak) {
  for (glm::vec3 normal : {glm::vec3(1, 0, 0), glm::vec3(0, -1, 0), glm::vec3(1, 1, 0), glm::vec3(1, -1, 0),
                           glm::vec3(-1, 0, 1), glm::vec3(0, 1, 1), glm::vec3(0, 1, -1), glm::vec3(1, 1, 1),
                           glm::vec3(1, -1, 1), glm::vec3(-1, -1, 1), glm::vec3(2, 1, 0), glm::vec3(1, 2, -3)}) {
    for (int swapped = 0; swapped < 2; ++swapped) {
      // Corners on the lattice of cell centres, so that rounding leaves them there.
      const glm::vec3 u = normal.z == 0.0f ? glm::vec3(0, 0, 1) : glm::vec3(normal.z, 0, -normal.x);
      const glm::vec3 v = glm::cross(normal, u), middle(0.0625f);
      Scene scene;
      Mesh& mesh = add_quad(scene, add_material(scene, kRed), middle - 4.0f * (u + v), 8.0f * u, 8.0f * v);
      if (swapped == 1) std::swap(mesh.triangles[1].y, mesh.triangles[1].z);
      const VoxelGrid voxels = voxelize_cpu(scene, unit_grid(16));
      const auto distance = [&](size_t i) { return glm::dot(centre(voxels.grid(), int(i)) - middle, normal); };
      std::vector<char> start(cell_count(voxels.grid()), 0);
      for (size_t i = 0; i < start.size(); ++i) start[i] = distance(i) < -1e-3f;
      const std::vector<char> reached = flood(voxels, start);
      int leaks = 0;
      for (size_t i = 0; i < start.size(); ++i) leaks += distance(i) > 1e-3f ? reached[i] : 0;
      EXPECT_EQ(leaks, 0) << normal.x << ' ' << normal.y << ' ' << normal.z << (swapped == 1 ? ", swapped" : "");
    }
  }
}

TEST(VoxelizeCpu, ClosedBoxesDoNotLeak) {
  for_closed_boxes([](const Scene& scene, glm::vec3 inside, const auto& outside, const std::string& what) {
    EXPECT_EQ(escapes(voxelize_cpu(scene, unit_grid(16)), inside, outside), 0) << what;
  });
}

TEST(VoxelizeCpu, RandomBoxesDoNotLeak) {
  Random random;
  for (int i = 0; i < 200; ++i) {
    const glm::vec3 middle = 0.1f * random.vec();
    const glm::vec3 half = glm::vec3(0.35f) + 0.1f * random.vec();
    const glm::vec3 axis = i % 4 == 0 ? glm::vec3(0, 1, 0) : random.vec() + 1e-3f;
    const glm::mat3 turn = i % 4 == 1 ? glm::mat3(1.0f) : rotation(glm::normalize(axis), 180.0f * random());
    Scene scene;
    add_box_inside(scene, add_material(scene, glm::vec3(0.5f)), middle, half, turn);
    const auto outside = [&](glm::vec3 p) {
      const glm::vec3 q = glm::abs(glm::transpose(turn) * (p - middle)) - half;
      return std::max({q.x, q.y, q.z});
    };
    const Grid grid = box_grid({20 + i % 5, 24 - i % 7, 18 + i % 11}, 0.1f, glm::vec3(-1.0f, -0.95f, -0.9f));
    EXPECT_EQ(escapes(voxelize_cpu(scene, grid), middle, outside), 0) << "box " << i;
  }
}

TEST(VoxelizeCpu, ClosedSpheresDoNotLeak) {
  for (int n : {16, 32}) {
    for (int rings : {8, 24, 40, 90}) {
      for (float radius : {0.7f, 0.75f, 0.8125f}) {
        Scene scene;
        add_sphere_inside(scene, add_material(scene, glm::vec3(0.5f)), glm::vec3(0.0f), radius, rings);
        const auto outside = [&](glm::vec3 p) { return glm::length(p) - radius; };
        EXPECT_EQ(escapes(voxelize_cpu(scene, unit_grid(n)), glm::vec3(0.0f), outside), 0)
            << n << " cells, " << rings << " rings, radius " << radius;
      }
    }
  }
}

}  // namespace
}  // namespace volgi::test
