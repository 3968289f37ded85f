// A continuous surface leaves no way through the volume, however thin or sloped, wherever the grid lies.
#include <gtest/gtest.h>

#include <map>
#include <memory>

#include "tests/support/gl_test.h"
#include "tests/support/volume_scenes.h"
#include "tests/support/voxels.h"

namespace volgi::test {
namespace {

class Watertight : public GlTest {
 protected:
  /// Cells behind a wall that light from before it reaches. The wall goes through the whole grid.
  int leaks(const Scene& scene, int n, glm::vec3 on_wall, glm::vec3 normal, float clearance) {
    auto& voxelization = voxelizations_[n];
    if (!voxelization) voxelization = std::make_unique<SlicedVoxelization>(unit_grid(n));
    const Voxels v = blocked_faces(context(), *voxelization, scene);
    const auto distance = [&](int i) { return glm::dot(v.centre(shared::cell_coord(v.grid, i)) - on_wall, normal); };
    std::vector<char> start(v.cells.size(), 0);
    int before = 0, behind = 0, leaking = 0;
    for (int i = 0; i < int(start.size()); ++i) start[size_t(i)] = distance(i) < -clearance;
    const std::vector<char> reached = v.flood(start);
    for (int i = 0; i < int(start.size()); ++i) {
      before += start[size_t(i)];
      if (distance(i) <= clearance) continue;
      ++behind;
      leaking += reached[size_t(i)];
    }
    EXPECT_GT(before, 0);
    EXPECT_GT(behind, 0);
    return leaking;
  }

 private:
  std::map<int, std::unique_ptr<SlicedVoxelization>> voxelizations_;
};

const glm::vec3 kNormals[] = {{1, 0, 0},
                              {0, -1, 0},
                              {0, 0, 1},
                              {1, 1, 0},
                              {1, -1, 0},
                              {-1, 0, 1},
                              {0, 1, 1},
                              {0, 1, -1},
                              {1, 1, 1},
                              {1, -1, 1},
                              {-1, -1, 1},
                              {2, 1, 0},
                              {1, -2, 0},
                              {3, -4, 0},
                              {0, 2, -1},
                              {1, 2, -3},
                              {5, 1, -2},
                              {1, 0.02f, -0.01f},
                              {0.31f, -0.83f, 0.47f},
                              {-0.11f, 0.23f, 0.9f}};

/// Offsets in cells from the grid's middle: through cell corners and face centres, through cell centres, and between.
const glm::vec3 kOffsets[] = {
    {0, 0, 0}, {0.5f, 0.5f, 0.5f}, {0.5f, 0, 0}, {0.25f, 0.1f, -0.3f}, {-0.37f, 0.41f, 0.17f}};

TEST_F(Watertight, SingleSheets) {
  for (int n : {16, 24, 32}) {
    for (glm::vec3 direction : kNormals) {
      for (glm::vec3 offset : kOffsets) {
        const glm::vec3 normal = glm::normalize(direction);
        const glm::vec3 on_wall = offset * (2.0f / float(n));
        Scene scene;
        add_square(scene, add_material(scene, glm::vec3(0.5f)), on_wall, normal, 4.0f);
        EXPECT_EQ(leaks(scene, n, on_wall, normal, 1.75f * 2.0f / float(n)), 0)
            << "grid " << n << ", normal " << direction.x << ' ' << direction.y << ' ' << direction.z << ", offset "
            << offset.x << ' ' << offset.y << ' ' << offset.z;
      }
    }
  }
}

TEST_F(Watertight, WallsThinnerThanACell) {
  for (int n : {16, 24, 32}) {
    for (glm::vec3 direction : kNormals) {
      for (glm::vec3 offset : kOffsets) {
        const glm::vec3 normal = glm::normalize(direction);
        const glm::vec3 on_wall = offset * (2.0f / float(n));
        Scene scene;
        const int grey = add_material(scene, glm::vec3(0.5f));
        add_square(scene, grey, on_wall, -normal, 4.0f);
        add_square(scene, grey, on_wall + 0.02f * normal, normal, 4.0f);
        EXPECT_EQ(leaks(scene, n, on_wall + 0.01f * normal, normal, 0.01f + 1.75f * 2.0f / float(n)), 0)
            << "grid " << n << ", normal " << direction.x << ' ' << direction.y << ' ' << direction.z << ", offset "
            << offset.x;
      }
    }
  }
}

// The two triangles of a wall wound differently, as exporters leave them.
TEST_F(Watertight, MixedWinding) {
  for (glm::vec3 direction : kNormals) {
    const glm::vec3 normal = glm::normalize(direction);
    const glm::vec3 on_wall(0.0625f);
    Scene scene;
    Mesh& mesh = add_square(scene, add_material(scene, glm::vec3(0.5f)), on_wall, normal, 4.0f);
    std::swap(mesh.triangles[1].y, mesh.triangles[1].z);
    EXPECT_EQ(leaks(scene, 16, on_wall, normal, 1.75f / 8.0f), 0)
        << direction.x << ' ' << direction.y << ' ' << direction.z;
  }
}

/// Cells outside a closed surface that its middle reaches; `outside` tells where a point lies [m beyond the surface].
template <class Outside>
int escapes(const Voxels& v, glm::vec3 middle, const Outside& outside) {
  std::vector<char> start(v.cells.size(), 0);
  start[size_t(shared::cell_index(v.grid, glm::ivec3(shared::cell_from_world(v.grid, middle))))] = 1;
  const std::vector<char> reached = v.flood(start);
  int count = 0;
  for (int i = 0; i < int(reached.size()); ++i) {
    // Vertices are rounded to 1/384 of a cell (slice_vertex).
    const bool beyond = outside(v.centre(shared::cell_coord(v.grid, i))) > v.grid.cell_size_m / 256.0f;
    count += beyond ? reached[size_t(i)] : 0;
  }
  return count;
}

// Closed boxes have edges, and where walls go through cell centres so do the edges.
TEST_F(Watertight, ClosedBoxes) {
  SlicedVoxelization voxelization(unit_grid(16));
  for_closed_boxes([&](const Scene& scene, glm::vec3 inside, const auto& outside, const std::string& what) {
    EXPECT_EQ(escapes(blocked_faces(context(), voxelization, scene), inside, outside), 0) << what;
  });
}

// Whatever the place and the turn: edges fall beside centres in every way.
TEST_F(Watertight, RandomBoxes) {
  SlicedVoxelization voxelization(unit_grid(32));
  std::uint32_t state = 1;
  const auto random = [&] { return float((state = state * 1664525u + 1013904223u) >> 8) * 0x1p-23f - 1.0f; };
  for (int i = 0; i < 80; ++i) {
    const glm::vec3 middle = 0.1f * glm::vec3(random(), random(), random());
    const glm::vec3 half = glm::vec3(0.35f) + 0.1f * glm::vec3(random(), random(), random());
    // Every other one upright or turned about one axis, as rooms are.
    const glm::vec3 axis = i % 4 == 0 ? glm::vec3(0, 1, 0) : glm::vec3(random(), random(), random()) + 1e-3f;
    const glm::mat3 turn = i % 4 == 1 ? glm::mat3(1.0f) : rotation(glm::normalize(axis), 180.0f * random());
    Scene scene;
    add_box_inside(scene, add_material(scene, glm::vec3(0.5f)), middle, half, turn);
    const auto outside = [&](glm::vec3 p) {
      const glm::vec3 q = glm::abs(glm::transpose(turn) * (p - middle)) - half;
      return std::max({q.x, q.y, q.z});
    };
    EXPECT_EQ(escapes(blocked_faces(context(), voxelization, scene), middle, outside), 0) << "box " << i;
  }
}

TEST_F(Watertight, ClosedSpheres) {
  for (int n : {16, 32}) {
    SlicedVoxelization voxelization(unit_grid(n));
    for (int rings : {8, 24, 40}) {
      for (float radius : {0.7f, 0.75f, 0.8125f}) {
        Scene scene;
        add_sphere_inside(scene, add_material(scene, glm::vec3(0.5f)), glm::vec3(0.0f), radius, rings);
        const auto outside = [&](glm::vec3 p) { return glm::length(p) - radius; };
        EXPECT_EQ(escapes(blocked_faces(context(), voxelization, scene), glm::vec3(0.0f), outside), 0)
            << n << " cells, " << rings << " rings, radius " << radius;
      }
    }
  }
}

// The grid of a closed box has no cell outside: the rim's outer faces must be the box's walls.
TEST_F(Watertight, BoxThatFillsItsGrid) {
  for (float shift : {0.0f, 0.25f, 0.5f}) {
    Scene scene;
    add_box_inside(scene, add_material(scene, glm::vec3(0.5f)), {0.3f, 0.0f, 0.1f}, {1.0f, 0.7f, 0.55f});
    const Voxels v = voxelize(context(), scene, make_grid(scene, 20, glm::vec3(shift)));
    std::vector<char> start(v.cells.size(), 0);
    start[size_t(shared::cell_index(v.grid, v.grid.cells / 2))] = 1;
    const std::vector<char> reached = v.flood(start);
    int open = 0;
    for (int i = 0; i < int(reached.size()); ++i) {
      const glm::ivec3 c = shared::cell_coord(v.grid, i);
      for (int face = 0; face < 6 && reached[size_t(i)] != 0; ++face) {
        if (!shared::cell_inside(v.grid, c + shared::face_step(face)) && !shared::is_opaque(v.cell(c), face)) ++open;
      }
    }
    EXPECT_EQ(open, 0) << "shift " << shift;
  }
}

}  // namespace
}  // namespace volgi::test
