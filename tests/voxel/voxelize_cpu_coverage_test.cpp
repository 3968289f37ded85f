// How much of a face, and of a surface, the CPU's sides stand for.
#include <gtest/gtest.h>

#include "tests/support/volume_scenes.h"
#include "tests/voxel/cpu_voxels.h"
#include "voxel/voxelize_cpu.h"

namespace volgi::test {
namespace {

/// Upright pole, width by width, through the whole grid.
void add_pole(Scene& scene, int material, glm::vec2 at, float width) {
  const float w = 0.5f * width;
  const glm::vec2 corners[4] = {{-w, -w}, {w, -w}, {w, w}, {-w, w}};
  for (size_t i = 0; i < 4; ++i) {
    const glm::vec2 a = at + corners[i], b = at + corners[(i + 1) % 4];
    add_quad(scene, material, {a.x, -2.0f, a.y}, {0.0f, 4.0f, 0.0f}, {b.x - a.x, 0.0f, b.y - a.y});
  }
}

// A pole thinner than a cell: seen along x or z, a row of cells is covered in the mean by its width. It is never gone.
TEST(VoxelizeCpu, PoleCoversItsWidthInTheMean) {
  for (float width : {0.34f, 0.5f, 0.8f}) {  // of a cell: no thinner than the lattice
    double sum = 0.0;
    int places = 0;
    const int steps = 24;
    for (int i = 0; i < steps; ++i) {
      for (int k = 0; k < steps; ++k) {
        Scene scene;
        const glm::vec2 at = (glm::vec2(i, k) + 0.37f) / float(steps);
        add_pole(scene, add_material(scene, kRed), at, width);
        const VoxelGrid v = voxelize_cpu(scene, box_grid({6, 3, 6}, 1.0f, {-3.0f, -1.5f, -3.0f}));
        EXPECT_GT(v.side_count(), 0u) << "width " << width << " at " << at.x << ' ' << at.y;
        // Light along z through the middle layer of cells: the share of each row that is not let through.
        double stopped = 0.0;
        for (int x = 0; x < 6; ++x) {
          double open = 1.0;
          for (int z = 0; z <= 6; ++z) {
            const Side* side = z < 6 ? side_of(v, {x, 1, z}, 4) : side_of(v, {x, 1, 5}, 5);
            if (side != nullptr) open = std::min(open, 1.0 - double(side->coverage));
          }
          stopped += 1.0 - open;
        }
        sum += stopped;
        ++places;
      }
    }
    EXPECT_NEAR(sum / places, double(width), 0.1 * double(width)) << "width " << width;
    RecordProperty("mean_" + std::to_string(int(100.0f * width)), std::to_string(sum / places));
  }
}

// A leaf smaller than a cell: its share of a face in the mean, opaque only where it covers the whole of it.
TEST(VoxelizeCpu, LeafCoversItsShare) {
  for (float edge : {0.4f, 0.7f}) {
    double sum = 0.0;
    const int steps = 18;
    for (int i = 0; i < steps; ++i) {
      for (int k = 0; k < steps; ++k) {
        Scene scene;
        const glm::vec2 at = (glm::vec2(i, k) + 0.41f) / float(steps);
        add_square(scene, add_material(scene, kRed), {0.1f, at.x, at.y}, {1, 0, 0}, 0.5f * edge);
        const VoxelGrid v = voxelize_cpu(scene, box_grid(glm::ivec3(4), 1.0f, glm::vec3(-2.0f)));
        for (const Side& side : v.sides()) {
          EXPECT_EQ(shared::face_axis(side.face), 0);
          EXPECT_LT(side.coverage, 1.0f);
          if (side.face == 0) sum += double(side.coverage);
          EXPECT_EQ(side.albedo, kRed);
        }
      }
    }
    const double mean = sum / (steps * steps);
    EXPECT_NEAR(mean, double(edge * edge), 0.1 * double(edge * edge)) << "edge " << edge;
    RecordProperty("mean_" + std::to_string(int(100.0f * edge)), std::to_string(mean));
  }
}

double area_in_front(const VoxelGrid& v, glm::vec3 normal) {
  double sum = 0.0;
  for (const Side& side : v.sides()) sum += glm::dot(side.normal, normal) > 0.0f ? double(side.area_m2) : 0.0;
  return sum;
}

TEST(VoxelizeCpu, AreasOfTiltedSquares) {
  double sum = 0.0, worst = 0.0;
  constexpr int kCount = 48;
  for (int i = 0; i < kCount; ++i) {
    const float z = (float(i) + 0.5f) / float(kCount);  // spread over the sphere (Fibonacci)
    const float phi = 2.399963f * float(i);
    const glm::vec3 normal(std::sqrt(1.0f - z * z) * std::cos(phi), std::sqrt(1.0f - z * z) * std::sin(phi), z);
    Scene scene;
    add_square(scene, add_material(scene, kRed), {0.01f, -0.02f, 0.017f}, normal, 0.5f);
    const VoxelGrid v = voxelize_cpu(scene, unit_grid(32));
    for (glm::vec3 facing : {normal, -normal}) {
      const double ratio = area_in_front(v, facing);  // the square has 1 m^2
      sum += 0.5 * ratio;
      worst = std::max(worst, std::abs(ratio - 1.0));
    }
  }
  EXPECT_NEAR(sum / kCount, 1.0, 0.003);
  EXPECT_LT(worst, 0.028);  // 16 cells wide, counted by thirds of a cell at the rim: one row more is 2 %
  RecordProperty("mean_ratio", std::to_string(sum / kCount));
  RecordProperty("worst", std::to_string(worst));
}

TEST(VoxelizeCpu, AreasOfASphere) {
  Scene scene;
  add_sphere_inside(scene, add_material(scene, kRed), {0.003f, 0.011f, -0.007f}, 0.85f, 32);
  const VoxelGrid v = voxelize_cpu(scene, unit_grid(32));
  double inner = 0.0, outer = 0.0;
  for (const Side& side : v.sides()) {
    (glm::dot(side.normal, centre(v.grid(), side.cell)) < 0.0f ? inner : outer) += double(side.area_m2);
  }
  EXPECT_NEAR(inner / area(scene), 1.0, 0.012);
  EXPECT_NEAR(outer / area(scene), 1.0, 0.012);
  RecordProperty("inner", std::to_string(inner / area(scene)));
  RecordProperty("outer", std::to_string(outer / area(scene)));
}

}  // namespace
}  // namespace volgi::test
