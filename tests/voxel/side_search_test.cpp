#include "voxel/side_search.h"

#include <gtest/gtest.h>

#include "core/surface.h"
#include "tests/support/volume_scenes.h"
#include "tests/voxel/cpu_voxels.h"
#include "voxel/seeing_cells.h"
#include "voxel/side_search_around.h"
#include "voxel/voxelize_cpu.h"

namespace volgi::test {
namespace {

TEST(SidesOfPoint, FindsWhatAWallShows) {
  Scene scene;
  const glm::vec3 normal = glm::normalize(glm::vec3(1.0f, 0.4f, -0.2f));
  add_square(scene, add_material(scene, kRed), glm::vec3(0.0f), normal, 0.6f);
  const VoxelGrid v = voxelize_cpu(scene, unit_grid(16));
  Random random;
  const glm::vec3 a = glm::normalize(glm::cross(normal, glm::vec3(0, 1, 0))), b = glm::cross(normal, a);
  for (int i = 0; i < 200; ++i) {
    const glm::vec3 point = 0.5f * (random() * a + random() * b);
    for (int front : {1, 0}) {
      const SidesOfPoint found = sides_of_point(v, point, front == 1 ? normal : -normal, front);
      EXPECT_NEAR(found.weights.x + found.weights.y + found.weights.z, 1.0f, 1e-6f);
      for (int axis = 0; axis < 3; ++axis) {
        ASSERT_GE(found.sides[axis], 0);
        const Side& side = v.sides()[size_t(found.sides[axis])];
        EXPECT_EQ(shared::face_axis(side.face), axis);
        EXPECT_EQ(side.front, front);
        EXPECT_GT(glm::dot(side.normal, front == 1 ? normal : -normal), 0.99f);
      }
    }
  }
  EXPECT_EQ(sides_of_point(v, {0.9f, 0.9f, 0.9f}, normal, -1).weights, glm::vec3(0.0f));
}

/// The search as the shader has it: column by column, twice, with nothing left out.
SidesOfPoint plain_search(const VoxelGrid& v, glm::vec3 point, glm::vec3 n, int front) {
  const int order[9] = {4, 0, 1, 2, 3, 5, 6, 7, 8};
  SidesOfPoint out;
  glm::ivec3 seeing = front < 0 ? seeing_cell(v, point, n) : glm::ivec3(glm::floor(point));
  const bool at_rim = front < 0 && !shared::cell_inside(v.grid(), seeing);
  if (at_rim) seeing = glm::ivec3(glm::floor(point));
  for (float min_cosine : {0.70710678f, 0.0f}) {
    for (int a = 0; a < 3; ++a) {
      const int b = shared::axis_b(a), c = shared::axis_c(a);
      if (std::abs(n[a]) < 1e-3f) continue;
      out.sides[a] = -1;
      for (int k = 0; k < 27 && out.sides[a] < 0; ++k) {
        glm::ivec3 cell = seeing;
        cell[b] += order[k / 3] % 3 - 1;
        cell[c] += order[k / 3] / 3 - 1;
        const float depth =
            point[a] + (n[b] * (point[b] - float(cell[b]) - 0.5f) + n[c] * (point[c] - float(cell[c]) - 0.5f)) / n[a];
        if (std::abs(depth - point[a]) > 3.0f) continue;
        cell[a] = shared::face_of_depth(depth, shared::falls_below_centre(n, a)) + (k % 3 == 2 ? -1 : k % 3) -
                  (n[a] > 0.0f ? 0 : 1);
        if (!shared::cell_inside(v.grid(), cell)) continue;
        const Side* side = side_of(v, cell, shared::face_of(a, !(n[a] > 0.0f)));
        if (side == nullptr || (front >= 0 && side->front != front)) continue;
        if (front < 0 && (hidden_from_cell(v, cell, point, n) || !(at_rim || open_way(v, seeing, cell)))) continue;
        const float cosine = glm::dot(side->normal, n), bounded = glm::clamp(cosine, 0.1f, 1.0f);
        const float behind = (side->depth - depth) * side->normal[a];
        if (front >= 0 && behind > 0.02f + 0.75f * std::sqrt(1.0f - bounded * bounded) / bounded) continue;
        if (cosine >= min_cosine && !(at_rim && min_cosine == 0.0f)) out.sides[a] = int(side - v.sides().data());
      }
      out.weights[a] = out.sides[a] >= 0 ? std::abs(n[a]) : 0.0f;
    }
    if (out.weights != glm::vec3(0.0f)) break;
  }
  out.weights /= std::max(out.weights.x + out.weights.y + out.weights.z, 1e-30f);
  return out;
}

// With and without columns of bits, one way and both: the answers of the plain search, but for ties by rounding.
TEST(SidesOfPoint, AgreesWithThePlainSearch) {
  const Scene scene = mixed_scene();
  const VoxelGrid v = voxelize_cpu(scene, box_grid({24, 17, 20}, 0.1f, {-1.2f, -0.85f, -1.0f}));
  const SideColumns columns(v);
  Random random;
  int asked = 0, other = 0, nothing = 0;
  const auto same = [](const SidesOfPoint& a, const SidesOfPoint& b) {
    return a.weights == b.weights && a.sides == b.sides;
  };
  for (const Mesh& mesh : scene.meshes) {
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      const float u = 0.5f + 0.5f * random(), w = (0.5f + 0.5f * random()) * (1.0f - u);
      const SurfacePoint at = surface_point(scene, mesh, t, u, w);
      const glm::vec3 point = shared::cell_from_world(v.grid(), at.position);
      const glm::vec3 n = t % 3 == 0 ? glm::normalize(at.geometric_normal + 0.5f * random.vec()) : at.geometric_normal;
      const glm::ivec3 cell(glm::floor(point));
      const SideSearch::Answer quick = SideSearch(v, &columns, n, 1, true).at(point, cell);
      const SideSearch::Answer slow = SideSearch(v, nullptr, n, 1, true).at(point, cell);
      const SidesOfPoint along = plain_search(v, point, n, 1), against = plain_search(v, point, -n, 0);
      asked += 3;
      nothing += (along.weights == glm::vec3(0.0f)) + (against.weights == glm::vec3(0.0f));
      EXPECT_TRUE(same(quick.along, slow.along) && same(quick.against, slow.against));
      other += !same(quick.along, along) + !same(quick.against, against);
      other += !same(sides_of_point(v, at.position, n, -1), plain_search(v, point, n, -1));
    }
  }
  EXPECT_GT(asked, 5000);
  EXPECT_GT(nothing, 50);  // failing is searched for to the end
  EXPECT_LT(other, asked / 500);
  RecordProperty("other", other);
}

// The same bits, in the columns that the kernels say matter.
TEST(ColumnsAround, KernelsAgree) {
  if (columns_around() == columns_around_baseline) GTEST_SKIP() << "there is no other kernel for this machine";
  Random random;
  constexpr int kStride = 20, kRow = 12 * kStride;
  std::vector<unsigned char> bytes(size_t(12 * kRow + 4));
  for (auto& byte : bytes) byte = random() > 0.4f ? static_cast<unsigned char>(127.5f + 127.5f * random()) : 0;
  int found = 0, left_out = 0;
  for (int i = 0; i < 20000; ++i) {
    const glm::vec3 point = 30.0f + 30.0f * random.vec(), low = glm::floor(point);
    const glm::vec3 slope = (i % 3 == 0 ? 8.0f : 2.0f) * random.vec();
    const unsigned char* own = bytes.data() + 5 * kRow + 5 * kStride + 4;
    const int to_face = 191 + i % 2;
    const AroundQuery query{point.x, point.y, point.z, low.x,   low.y, low.z,          slope.y,
                            slope.z, 3.0f,    to_face, kStride, kRow,  {own, own + 3}, {1, 2}};
    AroundColumns a, b;
    const unsigned mask = columns_around_baseline(query, a);
    ASSERT_EQ(mask, columns_around()(query, b));
    for (int k = 0; k < 16; ++k) {
      left_out += (mask >> k & 1u) == 0;
      if ((mask >> k & 1u) == 0) continue;
      ++found;
      ASSERT_EQ(a.depth[k % 8], b.depth[k % 8]);
      ASSERT_EQ(a.face[k % 8], b.face[k % 8]);
      ASSERT_EQ(a.three[k / 8][k % 8], b.three[k / 8][k % 8]);
    }
  }
  EXPECT_GT(found, 10000);
  EXPECT_GT(left_out, 10000);
}

}  // namespace
}  // namespace volgi::test
