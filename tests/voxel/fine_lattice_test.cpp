// What is thinner than a cell counts by its share, and what is not, as before. Both methods see the same.
#include <gtest/gtest.h>

#include <cstring>
#include <map>

#include "tests/support/gl_test.h"
#include "tests/support/volume_scenes.h"
#include "tests/support/voxels.h"

namespace volgi::test {
namespace {

class FineLattice : public GlTest {};

/// Numbers in [0,1), always the same.
class Random {
 public:
  float operator()() { return float((state_ = state_ * 1664525u + 1013904223u) >> 8) * 0x1p-24f; }
  glm::vec3 vector() { return {(*this)(), (*this)(), (*this)()}; }

 private:
  std::uint32_t state_ = 7;
};

/// Share that is stopped of the light along `axis` through each row of cells, summed over rows: the most covered face.
double stopped_rows(const Voxels& v, int axis) {
  std::map<std::pair<int, int>, double> rows;
  for (const Side& side : v.sides) {
    if (shared::face_axis(side.face) != axis) continue;
    const glm::ivec3 c = shared::cell_coord(v.grid, side.cell);
    double& row = rows[{c[shared::axis_b(axis)], c[shared::axis_c(axis)]}];
    row = std::max(row, double(side.coverage));
  }
  double sum = 0.0;
  for (const auto& row : rows) sum += row.second;
  return sum;
}

// A strip across the grid stops its width of the rows that it crosses, in the mean over its place.
TEST_F(FineLattice, StripsCountByTheirWidth) {
  const int n = 12;
  SlicedVoxelization voxelization(unit_grid(n));
  const float h = 2.0f / float(n);
  Random random;
  for (const float width : {0.1f, 0.35f, 0.8f}) {
    for (int axis = 0; axis < 3; ++axis) {
      double sum = 0.0;
      const int places = 60;
      for (int i = 0; i < places; ++i) {
        const int across = (axis + 1 + i % 2) % 3, along = 3 - axis - across;
        glm::vec3 corner, u(0.0f), v(0.0f);
        corner[axis] = h * random();
        corner[across] = h * (float(i) + random()) / float(places);
        corner[along] = -1.5f;
        u[across] = width * h;
        v[along] = 3.0f;
        Scene scene;
        add_quad(scene, add_material(scene, glm::vec3(0.5f)), corner, u, v);
        const Voxels found = voxelize(context(), voxelization, scene);
        sum += stopped_rows(found, axis) / double(n * places);
        for (const int other : {across, along}) EXPECT_EQ(stopped_rows(found, other), 0.0);
      }
      EXPECT_NEAR(sum / double(width), 1.0, 0.1) << width << " seen along " << axis;
    }
  }
}

// A closed pole hides the nodes within it. Where it holds the centre of a cell, it stops more than its width, where it
// stands across a mid-plane beside a centre, less; in the mean its width, and never nothing in both families.
TEST_F(FineLattice, PolesDoNotVanish) {
  const int n = 12;
  SlicedVoxelization voxelization(unit_grid(n));
  const float h = 2.0f / float(n);
  Random random;
  for (const float width : {0.35f, 0.5f, 0.8f}) {
    for (int axis = 0; axis < 3; ++axis) {
      double sum = 0.0;
      const int places = 49;
      for (int i = 0; i < places; ++i) {
        glm::vec3 half(0.5f * width * h), centre(0.0f);
        const int column = i % 7, row = i / 7;
        centre[(axis + 1) % 3] = h * (float(column) + random()) / 7.0f;
        centre[(axis + 2) % 3] = h * (float(row) + random()) / 7.0f;
        half[axis] = 1.5f;
        Scene scene;
        add_box_inside(scene, add_material(scene, glm::vec3(0.5f)), centre, half);
        const Voxels v = voxelize(context(), voxelization, scene);
        double stopped = 0.0;
        for (const int other : {(axis + 1) % 3, (axis + 2) % 3}) {
          stopped += stopped_rows(v, other) / double(n);
        }
        EXPECT_GT(stopped, 0.3) << width << " along " << axis << ", place " << i;
        sum += 0.5 * stopped / double(places);
        EXPECT_EQ(stopped_rows(v, axis), 0.0);
      }
      EXPECT_NEAR(sum / double(width), 1.0, 0.1) << "along " << axis;
    }
  }
}

// Leaves are squares smaller than a cell, turned in any way.
TEST_F(FineLattice, LeavesDoNotVanish) {
  const int n = 8;
  SlicedVoxelization voxelization(unit_grid(n));
  const float h = 2.0f / float(n);
  Random random;
  const float edge = 0.9f;
  double sum = 0.0, expected = 0.0;
  const int leaves = 150;
  for (int i = 0; i < leaves; ++i) {
    const glm::vec3 normal = glm::normalize(2.0f * random.vector() - 1.0f);
    Scene scene;
    add_square(scene, add_material(scene, glm::vec3(0.5f)), h * random.vector(), normal, 0.5f * edge * h);
    const Voxels v = voxelize(context(), voxelization, scene);
    double stopped = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
      stopped += stopped_rows(v, axis);
      expected += double(edge * edge * std::abs(normal[axis]));
    }
    EXPECT_GT(stopped, 0.0) << "leaf " << i;
    sum += stopped;
  }
  EXPECT_NEAR(sum / expected, 1.0, 0.1);
}

// A plane through the whole grid: every face that it touches is between centres on its two sides, and covered whole.
TEST_F(FineLattice, PlanesHaveNoFringe) {
  for (int n : {8, 15}) {
    SlicedVoxelization voxelization(unit_grid(n));
    Random random;
    for (int i = 0; i < 24; ++i) {
      const glm::vec3 normal =
          i < 3 ? glm::vec3(i == 0, i == 1, i == 2) : glm::normalize(2.0f * random.vector() - 1.0f);
      const glm::vec3 point = 0.4f * random.vector();
      Scene scene;
      add_square(scene, add_material(scene, glm::vec3(0.5f)), point, normal, 5.0f);
      const Voxels v = voxelize(context(), voxelization, scene);
      ASSERT_FALSE(v.sides.empty());
      for (const Side& side : v.sides) {
        const glm::ivec3 next = shared::cell_coord(v.grid, side.cell) + shared::face_step(side.face);
        if (!shared::cell_inside(v.grid, next)) continue;  // outside, all nodes count as seen
        ASSERT_EQ(side.coverage, 1.0f) << "normal " << normal.x << ' ' << normal.y << ' ' << normal.z;
        const float before = glm::dot(v.centre(shared::cell_coord(v.grid, side.cell)) - point, normal);
        ASSERT_LE(before * glm::dot(v.centre(next) - point, normal), 1e-3f);
      }
    }
  }
}

/// Furniture of a test: closed, open, thin, tilted, tiny, with and without alpha.
Scene clutter(bool alpha) {
  Scene scene;
  Random random;
  add_box_inside(scene, add_material(scene, glm::vec3(0.7f, 0.2f, 0.1f)), {0.01f, 0.02f, -0.03f}, glm::vec3(0.9f),
                 rotation(glm::normalize(glm::vec3(1, 2, 3)), 20.0f));
  add_sphere_inside(scene, add_material(scene, glm::vec3(0.2f, 0.5f, 0.3f)), {0.1f, -0.2f, 0.15f}, 0.4f, 16);
  add_square(scene, add_material(scene, glm::vec3(0.1f, 0.1f, 0.9f), glm::vec3(2.0f)), glm::vec3(0.125f), {0, 1, 0},
             0.6f);  // through cell centres
  const int leaf = add_material(scene, glm::vec3(0.3f, 0.8f, 0.2f));
  scene.materials[size_t(leaf)].alpha_mode = alpha ? AlphaMode::blend : AlphaMode::opaque;
  scene.materials[size_t(leaf)].base_color_factor.a = 0.4f;
  for (int i = 0; i < 200; ++i) {
    add_square(scene, leaf, 1.8f * random.vector() - 0.9f, 2.0f * random.vector() - 1.0f, 0.002f + 0.05f * random());
  }
  return scene;
}

void expect_same(const Voxels& a, const Voxels& b) {
  ASSERT_EQ(a.sides.size(), b.sides.size());
  ASSERT_EQ(a.cells.size(), b.cells.size());
  EXPECT_EQ(std::memcmp(a.sides.data(), b.sides.data(), a.sides.size() * sizeof(Side)), 0);
  for (size_t i = 0; i < a.cells.size(); ++i) {
    ASSERT_EQ(a.cells[i].y, b.cells[i].y);
    if ((a.cells[i].y & 63u) != 0) {  // else x means nothing
      ASSERT_EQ(a.cells[i].x, b.cells[i].x);
    }
  }
}

TEST_F(FineLattice, SinglePassSeesTheSame) {
  shared::Grid slab = unit_grid(16);
  slab.cells = {16, 9, 13};
  for (const shared::Grid& grid : {unit_grid(23), slab}) {
    SlicedVoxelization sliced(grid), single(grid, {.method = VoxelizationMethod::single_pass});
    for (const bool alpha : {false, true}) {
      const Scene scene = clutter(alpha);
      expect_same(voxelize(context(), sliced, scene), voxelize(context(), single, scene));
    }
  }
}

// An interleaved run finds the sides of one axis and counts their areas, and leaves the others' as they were.
TEST_F(FineLattice, InterleavedRunsBecomeAFullOne) {
  const Grid grid = unit_grid(16);
  gl::PassTimer timer(context().software(), false);
  SlicedVoxelization interleaved(grid);
  const gl::SceneBuffers before(clutter(true));
  interleaved.run(before, timer, 1);  // the first run is a full one
  expect_same(downloaded(interleaved.voxels()), voxelize(context(), clutter(true), grid));
  Scene moved = clutter(true);
  for (Mesh& mesh : moved.meshes) {
    for (glm::vec3& p : mesh.positions) p = rotation({0, 1, 0}, 7.0f) * p + glm::vec3(0.02f, 0.05f, 0.0f);
  }
  const gl::SceneBuffers after(moved);
  for (int axis = 0; axis < 3; ++axis) {
    interleaved.run(after, timer, axis);
    const Voxels v = downloaded(interleaved.voxels());
    EXPECT_GT(v.sides.size(), 1000u);
    for (const Side& side : v.sides) ASSERT_TRUE(std::isfinite(side.area_m2) && side.coverage > 0.0f);
  }
  const Voxels full = voxelize(context(), moved, grid);
  ASSERT_EQ(downloaded(interleaved.voxels()).sides.size(), full.sides.size());
  for (int axis = 0; axis < 3; ++axis) interleaved.run(after, timer, axis);  // areas are shared by sides of all axes
  expect_same(downloaded(interleaved.voxels()), full);
}

// Coverage is found anew, since ways to a face go along other axes' planes; areas are counted for the sliced axis only.
TEST_F(FineLattice, AnInterleavedRunCountsAreasOfOneAxis) {
  const Grid grid = unit_grid(16);
  gl::PassTimer timer(context().software(), false);
  SlicedVoxelization interleaved(grid, {.interleave = true});
  interleaved.run(gl::SceneBuffers(clutter(true)), timer);  // the first run is a full one
  const Voxels before = downloaded(interleaved.voxels());
  Scene moved = clutter(true);
  for (Mesh& mesh : moved.meshes) {
    for (glm::vec3& p : mesh.positions) p = rotation({0, 1, 0}, 7.0f) * p + glm::vec3(0.02f, 0.05f, 0.0f);
  }
  interleaved.run(gl::SceneBuffers(moved), timer);  // x was the full one's, y is next
  const Voxels after = downloaded(interleaved.voxels());
  std::map<std::pair<int, int>, float> area_before;
  for (const Side& side : before.sides) area_before[{side.cell, side.face}] = side.area_m2;
  glm::ivec3 kept(0), changed(0);
  for (const Side& side : after.sides) {
    const auto old = area_before.find({side.cell, side.face});
    if (old != area_before.end()) ++(old->second == side.area_m2 ? kept : changed)[shared::face_axis(side.face)];
  }
  for (int axis : {0, 2}) {
    EXPECT_GT(kept[axis], 500) << axis;
    EXPECT_EQ(changed[axis], 0) << axis;
  }
  EXPECT_GT(changed.y, 500);
}

// A list that is too short leaves sides out, but no cell looks beyond it and nothing opens.
TEST_F(FineLattice, TooManySidesStayInside) {
  const Grid grid = unit_grid(24);
  gl::PassTimer timer(context().software(), false);
  SlicedVoxelization voxelization(grid);
  Scene small, large;
  add_square(small, add_material(small, glm::vec3(0.5f)), glm::vec3(0.0f), {0, 1, 0}, 0.2f);
  add_sphere_inside(large, add_material(large, glm::vec3(0.5f)), glm::vec3(0.0f), 0.8f, 24);
  voxelization.run(gl::SceneBuffers(small), timer);
  voxelization.run(gl::SceneBuffers(large), timer);
  const Voxels v = downloaded(voxelization.voxels());
  EXPECT_LE(v.sides.size(), voxelization.voxels().side_capacity);
  const Voxels whole = voxelize(context(), large, grid);
  size_t known = 0;
  for (size_t i = 0; i < v.cells.size(); ++i) {
    const auto count = size_t(glm::bitCount(v.cells[i].y & 63u));
    if (count > 0) {
      EXPECT_LE(v.cells[i].x + count, v.sides.size());
    }
    known += count;
    EXPECT_EQ(v.cells[i].y >> 8, whole.cells[i].y >> 8);
  }
  EXPECT_EQ(known, v.sides.size());
  EXPECT_LT(known, whole.sides.size());
}

TEST_F(FineLattice, UploadAndDownload) {
  const Grid grid = unit_grid(13);
  SlicedVoxelization voxelization(grid);
  const Voxels v = voxelize(context(), voxelization, clutter(true));
  const VoxelGrid cpu = volgi::download(voxelization.voxels());
  ASSERT_EQ(cpu.side_count(), v.sides.size());
  VoxelGridGl again = volgi::upload(cpu);
  expect_same(downloaded(again), v);
  // Into room that there is: the same buffers.
  const GLuint cells = again.cell_sides.id(), sides = again.sides.id();
  Scene few;
  add_square(few, add_material(few, glm::vec3(0.5f)), glm::vec3(0.0f), {0, 1, 0}, 0.4f);
  const Voxels f = voxelize(context(), voxelization, few);
  volgi::upload(volgi::download(voxelization.voxels()), again);
  EXPECT_EQ(again.cell_sides.id(), cells);
  EXPECT_EQ(again.sides.id(), sides);
  expect_same(downloaded(again), f);
}

TEST_F(FineLattice, LongGridsAndStatedMemory) {
  for (glm::ivec3 cells : {glm::ivec3(256, 16, 16), glm::ivec3(3, 200, 5), glm::ivec3(1, 1, 64), glm::ivec3(40)}) {
    Grid grid{};
    grid.cells = cells;
    grid.cell_size_m = 0.1f;
    const glm::vec3 half = 0.05f * glm::vec3(cells);
    grid.origin = -half;
    Scene room;  // walls of the box and some planes within
    add_box_inside(room, add_material(room, glm::vec3(0.5f)), glm::vec3(0.0f), half);
    add_square(room, add_material(room, glm::vec3(0.5f)), glm::vec3(0.01f), {0.1f, 1.0f, 0.2f}, 100.0f);
    SlicedVoxelization voxelization(grid);
    const Voxels v = voxelize(context(), voxelization, room);
    const double box = 2.0 * double(cells.x * cells.y + cells.y * cells.z + cells.z * cells.x);
    EXPECT_GT(double(v.sides.size()), box);
    for (int k = 0; k < cells.x * cells.y * cells.z; ++k) {  // the box is closed
      for (int face = 0; face < 6; ++face) {
        const glm::ivec3 c = shared::cell_coord(grid, k);
        if (!shared::cell_inside(grid, c + shared::face_step(face))) {
          ASSERT_TRUE(shared::is_opaque(v.cell(c), face));
        }
      }
    }
  }
  const Scene scene = clutter(true);
  SlicedVoxelization voxelization(unit_grid(40));
  voxelize(context(), voxelization, scene);
  EXPECT_NEAR(double(voxelization_bytes(unit_grid(40), scene, expected_sides(scene, unit_grid(40)))) /
                  double(voxelization.bytes()),
              1.0, 0.1);
  const Grid largest = unit_grid(256);
  EXPECT_LT(double(voxelization_bytes(largest, Scene(), expected_sides(Scene(), largest))), 1.2e9);
  for (int axis = 0; axis < 3; ++axis) EXPECT_LT(4 * shared::face_count(largest, axis), 128 << 20);
}

}  // namespace
}  // namespace volgi::test
