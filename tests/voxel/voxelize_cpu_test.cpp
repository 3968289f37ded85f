#include "voxel/voxelize_cpu.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cstring>

#include "core/surface.h"
#include "tests/support/volume_scenes.h"
#include "voxel/side_search.h"

namespace volgi::test {
namespace {

using shared::Side;

const glm::vec3 kRed(0.8f, 0.1f, 0.2f);
const glm::vec3 kBlue(0.1f, 0.3f, 0.7f);

Grid box_grid(glm::ivec3 cells, float h, glm::vec3 origin) {
  Grid grid{};
  grid.cells = cells;
  grid.cell_size_m = h;
  grid.origin = origin;
  return grid;
}

glm::vec3 centre(const Grid& grid, int cell) {
  return shared::world_from_cell(grid, glm::vec3(shared::cell_coord(grid, cell)) + 0.5f);
}

const Side* side_of(const VoxelGrid& v, glm::ivec3 cell, int face) {
  const glm::uvec2 own = v.cell_sides(cell);
  return shared::has_side(own, face) ? &v.sides()[shared::side_index(own, face)] : nullptr;
}

/// Cells that light from the marked ones reaches through faces that do not stop everything.
std::vector<char> flood(const VoxelGrid& v, std::vector<char> reached) {
  std::vector<int> open;
  for (size_t i = 0; i < reached.size(); ++i) {
    if (reached[i] != 0) open.push_back(int(i));
  }
  while (!open.empty()) {
    const glm::ivec3 c = shared::cell_coord(v.grid(), open.back());
    open.pop_back();
    for (int face = 0; face < 6; ++face) {
      const glm::ivec3 next = c + shared::face_step(face);
      if (!shared::cell_inside(v.grid(), next) || shared::is_opaque(v.cell_sides(c), face)) continue;
      char& mark = reached[size_t(shared::cell_index(v.grid(), next))];
      if (mark == 0) open.push_back(shared::cell_index(v.grid(), next));
      mark = 1;
    }
  }
  return reached;
}

/// Cells for which outside(centre) [m] is above a rounding step that light from around `middle` reaches.
template <class Outside>
int escapes(const VoxelGrid& v, glm::vec3 middle, const Outside& outside) {
  const Grid& grid = v.grid();
  std::vector<char> start(cell_count(grid), 0);
  start[size_t(shared::cell_index(grid, glm::ivec3(shared::cell_from_world(grid, middle))))] = 1;
  const std::vector<char> reached = flood(v, start);
  int count = 0;
  for (int i = 0; i < int(reached.size()); ++i) {
    count += outside(centre(grid, i)) > grid.cell_size_m / 192.0f ? reached[size_t(i)] : 0;
  }
  return count;
}

struct Random {
  std::uint32_t state = 1;
  float operator()() { return float((state = state * 1664525u + 1013904223u) >> 8) * 0x1p-23f - 1.0f; }
  glm::vec3 vec() { return {(*this)(), (*this)(), (*this)()}; }
};

TEST(VoxelizeCpu, WallOnAxisBlocksOneFaceAColumn) {
  Scene scene;
  add_square(scene, add_material(scene, kRed), {0.3f, 0.0f, 0.0f}, {1.0f, 0.0f, 0.0f}, 2.0f);
  const VoxelGrid v = voxelize_cpu(scene, unit_grid(16));
  ASSERT_EQ(v.side_count(), 2u * 16 * 16);
  const int left = 9;  // 0.3 is at 10.4 cells, between the centres of the cells 9 and 10
  for (const Side& side : v.sides()) {
    const glm::ivec3 c = shared::cell_coord(v.grid(), side.cell);
    EXPECT_EQ(shared::face_axis(side.face), 0);
    EXPECT_EQ(c.x, side.face == 1 ? left : left + 1);
    EXPECT_EQ(side.normal, glm::vec3(side.face == 1 ? -1.0f : 1.0f, 0.0f, 0.0f));
    EXPECT_EQ(side.coverage, 1.0f);
    EXPECT_NEAR(side.area_m2, 1.0f / 64.0f, 1e-6f);
    EXPECT_NEAR(side.face_m2, 1.0f / 64.0f, 1e-7f);
    EXPECT_EQ(side.front, side.face == 0 ? 1 : 0);
    EXPECT_NEAR(side.depth, 10.4f, 1.0f / 384.0f);
    for (int band = 0; band < 3; ++band) EXPECT_NEAR(side.albedo[band], kRed[band], 1e-6f);
    EXPECT_EQ(side.radiosity, glm::vec3(0.0f));
    EXPECT_EQ(side_of(v, c, side.face), &side);
    EXPECT_TRUE(shared::is_opaque(v.cell_sides(c), side.face));
  }
}

// The tree that voxelization fills in parallel is the one that the sides alone would give.
TEST(VoxelizeCpu, TreeAgreesWithItsSides) {
  Scene scene;
  const int grey = add_material(scene, glm::vec3(0.5f));
  add_sphere_inside(scene, grey, {0.1f, 0.0f, -0.05f}, 0.6f, 12);
  add_square(scene, grey, {0.0f, 0.0f, 0.0f}, {1.0f, -2.0f, 0.5f}, 0.4f);
  add_square(scene, grey, {0.7f, 0.7f, 0.7f}, {1.0f, -2.0f, 0.5f}, 0.01f);
  for (glm::ivec3 cells : {glm::ivec3(20), glm::ivec3(24, 16, 21), glm::ivec3(8)}) {
    const VoxelGrid v = voxelize_cpu(scene, box_grid(cells, 0.1f, {-1.0f, -0.8f, -1.05f}));
    ASSERT_GT(v.side_count(), 30u);
    const VoxelGrid again(v.grid(), v.sides());
    for (int i = 0; i < int(cell_count(v.grid())); ++i) {
      const glm::ivec3 c = shared::cell_coord(v.grid(), i);
      const glm::uvec2 own = v.cell_sides(c), expected = again.cell_sides(c);
      EXPECT_EQ(own.y, expected.y);
      EXPECT_EQ(own.x, expected.y != 0 ? expected.x : own.x);
    }
    EXPECT_EQ(v.cell_sides_tree().activeVoxelCount(), again.cell_sides_tree().activeVoxelCount());
    for (const Side& side : v.sides()) {
      const int axis = shared::face_axis(side.face);
      EXPECT_LT(side.normal[axis] * float(shared::face_sign(side.face)), 0.0f);
      EXPECT_NEAR(glm::length(side.normal), 1.0f, 1e-5f);
      EXPECT_GT(side.area_m2, 0.0f);
      EXPECT_GT(side.coverage, 0.0f);
      EXPECT_LE(side.coverage, 1.0f);
      // Where the line through the centres is blocked, the surface lies between them. Elsewhere its plane need not.
      if (side.coverage < 1.0f) continue;
      const float ahead = (side.depth - float(shared::cell_coord(v.grid(), side.cell)[axis]) - 0.5f) *
                          float(shared::face_sign(side.face));
      EXPECT_GE(ahead, 0.0f);
      EXPECT_LE(ahead, 1.0f);
    }
  }
}

TEST(VoxelizeCpu, NothingToSee) {
  Scene none;
  none.materials.emplace_back();
  EXPECT_EQ(voxelize_cpu(none, unit_grid(4)).side_count(), 0u);
  EXPECT_EQ(cell_volumes_cpu(none, unit_grid(4)).occupancy->activeVoxelCount(), 0u);
  Scene outside;
  add_square(outside, add_material(outside, kRed), {3.0f, 0.0f, 0.0f}, {1.0f, 0.0f, 0.0f}, 0.5f);
  EXPECT_EQ(voxelize_cpu(outside, unit_grid(4)).side_count(), 0u);
  Scene degenerate;
  Mesh& mesh = add_square(degenerate, add_material(degenerate, kRed), glm::vec3(0.0f), {1.0f, 0.3f, 0.0f}, 0.5f);
  mesh.positions[2] = mesh.positions[1];
  mesh.positions[3] = mesh.positions[0];
  EXPECT_EQ(voxelize_cpu(degenerate, unit_grid(16)).side_count(), 0u);
  // A wall one cell long and one that lies in the grid's rim.
  Scene small;
  add_square(small, add_material(small, kRed), {-1.0f, 0.0f, 0.0f}, {1.0f, 0.0f, 0.0f}, 2.0f);
  const VoxelGrid v = voxelize_cpu(small, box_grid({1, 1, 1}, 2.0f, glm::vec3(-1.0f)));
  ASSERT_EQ(v.side_count(), 1u);
  EXPECT_EQ(v.sides()[0].face, 0);
}

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
  const glm::mat3 turns[] = {glm::mat3(1.0f), rotation({0, 1, 0}, 45.0f), rotation({1, 0, 0}, 45.0f),
                             rotation({0, 0, 1}, 30.0f),
                             rotation({0, 1, 0}, 30.0f) * rotation({1, 0, 0}, 20.0f) * rotation({0, 0, 1}, 10.0f)};
  for (int t = 0; t < 5; ++t) {
    const glm::mat3& turn = turns[t];
    for (float half : {0.5f, 0.5625f, 0.51f, 0.4999f, 0.4375f}) {  // faces of cells, centres of cells, between
      for (glm::vec3 offset : {glm::vec3(0.0f), glm::vec3(0.0625f), glm::vec3(0.013f, -0.027f, 0.04f)}) {
        Scene scene;
        add_box_inside(scene, add_material(scene, glm::vec3(0.5f)), offset, glm::vec3(half), turn);
        const auto outside = [&](glm::vec3 p) {
          const glm::vec3 q = glm::abs(glm::transpose(turn) * (p - offset)) - half;
          return std::max({q.x, q.y, q.z});
        };
        EXPECT_EQ(escapes(voxelize_cpu(scene, unit_grid(16)), offset, outside), 0)
            << "turn " << t << ", half edge " << half << ", offset " << offset.x;
      }
    }
  }
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

// The two sheets of a wall thinner than a cell, and of one as thick as two: each cell sees its own.
TEST(VoxelizeCpu, SheetsOfAWallKeepTheirAlbedo) {
  for (float thickness : {0.02f, 0.25f}) {
    for (glm::vec3 direction : {glm::vec3(1, 0, 0), glm::vec3(0, 0, -1), glm::vec3(1, 1, 0), glm::vec3(2, -1, 1)}) {
      const glm::vec3 normal = glm::normalize(direction);
      Scene scene;
      add_square(scene, add_material(scene, kRed), 0.003f * normal, -normal, 4.0f);
      add_square(scene, add_material(scene, kBlue), (0.003f + thickness) * normal, normal, 4.0f);
      const VoxelGrid v = voxelize_cpu(scene, unit_grid(16));
      int wrong = 0;
      for (const Side& side : v.sides()) {
        const float distance = glm::dot(centre(v.grid(), side.cell), normal);
        if (distance > 0.002f && distance < 0.004f + thickness) continue;  // inside the wall
        wrong += glm::distance(side.albedo, distance < 0.003f ? kRed : kBlue) > 1e-5f;
      }
      EXPECT_EQ(wrong, 0) << thickness << ": " << direction.x << ' ' << direction.y << ' ' << direction.z;
    }
  }
}

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
  EXPECT_LT(worst, 0.03);  // 16 cells wide, counted by thirds of a cell at the rim: one row more is 2 %
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

TEST(VoxelizeCpu, BlendCoversAShare) {
  Scene scene;
  const int glass = add_material(scene, kRed);
  scene.materials[0].alpha_mode = AlphaMode::blend;
  scene.materials[0].base_color_factor.a = 0.3f;
  add_square(scene, glass, {0.3f, 0.0f, 0.0f}, {1.0f, 0.0f, 0.0f}, 2.0f);
  const Grid grid = unit_grid(8);
  const VoxelGrid one = voxelize_cpu(scene, grid);
  ASSERT_EQ(one.side_count(), 2u * 64);
  for (const Side& side : one.sides()) {
    EXPECT_NEAR(side.coverage, 0.3f, 1e-4f);
    EXPECT_NEAR(side.area_m2, 0.3f / 16.0f, 1e-5f);
    EXPECT_FALSE(shared::is_opaque(one.cell_sides(shared::cell_coord(grid, side.cell)), side.face));
  }
  add_square(scene, glass, {0.31f, 0.0f, 0.0f}, {1.0f, 0.0f, 0.0f}, 2.0f);  // the same face: 1 - 0.7^2
  const VoxelGrid two = voxelize_cpu(scene, grid);
  for (const Side& side : two.sides()) EXPECT_NEAR(side.coverage, 0.51f, 1e-4f);
  scene.materials[0].base_color_factor.a = 1.0f;
  const VoxelGrid opaque = voxelize_cpu(scene, grid);
  for (const Side& side : opaque.sides()) {
    EXPECT_TRUE(shared::is_opaque(opaque.cell_sides(shared::cell_coord(grid, side.cell)), side.face));
  }
  scene.materials[0].base_color_factor.a = 0.99f;  // many layers stop nearly everything, but are not opaque
  for (int i = 0; i < 8; ++i) add_square(scene, glass, {0.3f, 0.0f, 0.0f}, {1.0f, 0.0f, 0.0f}, 2.0f);
  const VoxelGrid many = voxelize_cpu(scene, grid);
  for (const Side& side : many.sides()) EXPECT_LT(side.coverage, 1.0f);
}

TEST(VoxelizeCpu, MaskCuts) {
  Scene scene;
  add_square(scene, add_material(scene, kRed), {0.3f, 0.0f, 0.0f}, {1.0f, 0.0f, 0.0f}, 1.0f);
  scene.materials[0].alpha_mode = AlphaMode::mask;
  scene.materials[0].base_color_factor.a = 0.6f;
  EXPECT_EQ(voxelize_cpu(scene, unit_grid(8)).side_count(), 2u * 64);
  scene.materials[0].base_color_factor.a = 0.4f;
  EXPECT_EQ(voxelize_cpu(scene, unit_grid(8)).side_count(), 0u);
  // A texture whose left half is cut away: at 8 cells between faces, at 9 through the middle of a row of them, of whose
  // nine lines six or three are left.
  TextureImage image{8, 1, {}};
  for (int i = 0; i < 8; ++i) image.rgba.insert(image.rgba.end(), {255, 255, 255, std::uint8_t(i < 4 ? 0 : 255)});
  scene.images.push_back(image);
  scene.textures.push_back({0, {Wrap::clamp_to_edge, Wrap::clamp_to_edge, true, true, false, false}});
  scene.materials[0].base_color.texture = 0;
  scene.materials[0].base_color_factor.a = 1.0f;
  const VoxelGrid half = voxelize_cpu(scene, unit_grid(8));
  EXPECT_EQ(half.side_count(), 2u * 32);
  for (const Side& side : half.sides()) EXPECT_EQ(side.coverage, 1.0f);
  const VoxelGrid odd = voxelize_cpu(scene, unit_grid(9));
  EXPECT_EQ(odd.side_count(), 2u * 45);
  int partial = 0;
  for (const Side& side : odd.sides()) {
    if (side.coverage == 1.0f) continue;
    ++partial;
    EXPECT_GT(side.coverage, 0.3f);
    EXPECT_LT(side.coverage, 0.7f);
  }
  EXPECT_EQ(partial, 2 * 9);
}

TEST(VoxelizeCpu, EmissionIsOneSided) {
  const glm::vec3 radiance(2.0f, 1.0f, 0.0f);
  Scene scene;
  add_square(scene, add_material(scene, kRed, radiance), {0.3f, 0.0f, 0.0f}, {1.0f, 1.0f, 0.0f}, 2.0f);
  const VoxelGrid v = voxelize_cpu(scene, unit_grid(8));
  ASSERT_GT(v.side_count(), 0u);
  for (const Side& side : v.sides()) {
    const glm::vec3 expected = side.normal.x > 0.0f ? glm::pi<float>() * radiance : glm::vec3(0.0f);
    EXPECT_LT(glm::distance(side.radiosity, expected), 1e-5f);
  }
  scene.materials[0].double_sided = true;
  const VoxelGrid both = voxelize_cpu(scene, unit_grid(8));
  for (const Side& side : both.sides()) {
    EXPECT_LT(glm::distance(side.radiosity, glm::pi<float>() * radiance), 1e-5f);
  }
}

Scene mixed_scene() {
  Scene scene;
  const int red = add_material(scene, kRed), blue = add_material(scene, kBlue, glm::vec3(1.0f));
  const int haze = add_material(scene, glm::vec3(0.9f));
  scene.materials[size_t(haze)].alpha_mode = AlphaMode::blend;
  scene.materials[size_t(haze)].base_color_factor.a = 0.4f;
  add_sphere_inside(scene, red, {0.0f, 0.1f, 0.0f}, 0.8f, 24);
  add_square(scene, blue, {0.3f, 0.0f, 0.0f}, {1.0f, 1.0f, 0.3f}, 0.7f);
  add_square(scene, red, {0.3f, 0.0f, 0.0f}, {1.0f, 1.0f, 0.3f}, 0.7f);  // the same place
  add_sphere_inside(scene, haze, {0.1f, 0.1f, 0.2f}, 0.5f, 12);
  return scene;
}

template <class GridPtr>
std::vector<float> values_of(const GridPtr& grid) {
  std::vector<float> out;
  for (auto it = grid->cbeginValueOn(); it; ++it) {
    const auto value = *it;
    const auto* floats = reinterpret_cast<const float*>(&value);
    for (int axis = 0; axis < 3; ++axis) out.push_back(float(it.getCoord()[axis]));
    out.insert(out.end(), floats, floats + sizeof(value) / sizeof(float));
  }
  return out;
}

// Sums are made of integers, lists have a fixed order: the number of threads does not show.
TEST(VoxelizeCpu, ThreadsDoNotShow) {
  const Scene scene = mixed_scene();
  const auto with_threads = [&](size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return voxelize_all_cpu(scene, unit_grid(40));
  };
  const Voxelized one = with_threads(1);
  for (size_t threads : {1, 2, 2, 4}) {
    const Voxelized other = with_threads(threads);
    ASSERT_EQ(one.voxels.side_count(), other.voxels.side_count());
    EXPECT_EQ(
        std::memcmp(one.voxels.sides().data(), other.voxels.sides().data(), one.voxels.side_count() * sizeof(Side)), 0);
    EXPECT_EQ(values_of(one.cells.occupancy), values_of(other.cells.occupancy));
    EXPECT_EQ(values_of(one.cells.albedo), values_of(other.cells.albedo));
    EXPECT_EQ(values_of(one.cells.normal), values_of(other.cells.normal));
    EXPECT_EQ(values_of(one.cells.emission), values_of(other.cells.emission));
  }
}

// A scene and a grid turned by a quarter about x have the same sides, turned.
TEST(VoxelizeCpu, TurnsWithTheScene) {
  Scene scene = mixed_scene();
  for (Mesh& mesh : scene.meshes) {
    for (glm::vec3& p : mesh.positions) p.y *= 0.6f;
  }
  Scene turned = scene;
  for (Mesh& mesh : turned.meshes) {
    for (glm::vec3& p : mesh.positions) p = {p.z, p.x, p.y};
  }
  const VoxelGrid a = voxelize_cpu(scene, box_grid({20, 13, 17}, 0.1f, {-1.0f, -0.65f, -0.85f}));
  const VoxelGrid b = voxelize_cpu(turned, box_grid({17, 20, 13}, 0.1f, {-0.85f, -1.0f, -0.65f}));
  EXPECT_NEAR(double(a.side_count()), double(b.side_count()), 0.002 * double(a.side_count()));
  int same = 0;
  for (const Side& side : a.sides()) {
    const glm::ivec3 c = shared::cell_coord(a.grid(), side.cell);
    const int face = (side.face + 2) % 6;
    const Side* other = side_of(b, {c.z, c.x, c.y}, face);
    if (other == nullptr) continue;
    same += std::abs(other->coverage - side.coverage) < 1e-6f && other->front == side.front &&
            std::abs(other->area_m2 - side.area_m2) < 1e-3f * side.area_m2;
  }
  EXPECT_GT(same, int(0.99 * double(a.side_count())));  // ties go another way
}

TEST(CellVolumesCpu, MeansOfACellAndMaxima) {
  Scene scene;
  const int red = add_material(scene, kRed, glm::vec3(1.0f, 2.0f, 0.0f));
  const int blue = add_material(scene, kBlue, glm::vec3(3.0f, 1.0f, 0.0f));
  // Two squares through the whole grid: back to back 0.02 apart, in the cells x = 5 of 8; one of glass at x = 2.
  add_square(scene, red, {0.30f, 0.0f, 0.0f}, {1, 0, 0}, 2.0f);
  add_square(scene, blue, {0.32f, 0.0f, 0.0f}, {1, 0.2f, 0}, 2.0f);
  const int glass = add_material(scene, glm::vec3(1.0f));
  scene.materials[size_t(glass)].alpha_mode = AlphaMode::blend;
  scene.materials[size_t(glass)].base_color_factor.a = 0.25f;
  add_square(scene, glass, {-0.40f, 0.0f, 0.0f}, {1, 0, 0}, 2.0f);
  add_square(scene, glass, {-0.39f, 0.0f, 0.0f}, {-1, 0, 0}, 2.0f);
  const CellVolumes cells = cell_volumes_cpu(scene, unit_grid(8));
  const openvdb::Coord middle(5, 4, 4), glassy(2, 4, 4), empty(7, 4, 4);
  EXPECT_FLOAT_EQ(cells.occupancy->tree().getValue(middle), 1.0f);
  EXPECT_FLOAT_EQ(cells.occupancy->tree().getValue(glassy), 0.25f);
  EXPECT_FALSE(cells.occupancy->tree().isValueOn(empty));
  const openvdb::Vec3s albedo = cells.albedo->tree().getValue(middle);
  const openvdb::Vec3s emission = cells.emission->tree().getValue(middle);
  const openvdb::Vec3s normal = cells.normal->tree().getValue(middle);
  const double share = std::sqrt(1.04) / (1.0 + std::sqrt(1.04));  // of blue, which is tilted
  for (int band = 0; band < 3; ++band) {
    EXPECT_NEAR(albedo[band], (1.0 - share) * double(kRed[band]) + share * double(kBlue[band]), 1e-5);
  }
  EXPECT_NEAR(emission[0], 3.0f * glm::pi<float>(), 1e-5f);
  EXPECT_NEAR(emission[1], 2.0f * glm::pi<float>(), 1e-5f);
  EXPECT_NEAR(normal.length(), 1.0f, 1e-5f);
  EXPECT_NEAR(normal[1] / normal[0], 0.2f / 2.0f, 1e-3f);
  EXPECT_EQ(cells.normal->tree().getValue(glassy), openvdb::Vec3s(0.0f));  // they cancel
  EXPECT_NEAR(cells.emission->tree().getValue(glassy)[0], 0.0f, 0.0f);
}

// Walls on the grid's rim belong to its outermost cells, also where these fill their last block.
TEST(CellVolumesCpu, RimBelongsToTheGrid) {
  for (int n : {5, 8, 16}) {
    Scene scene;
    add_box_inside(scene, add_material(scene, kRed), glm::vec3(0.0f), glm::vec3(1.0f));
    scene.world_origin = {10.0, 0.0, 0.0};
    const CellVolumes cells = cell_volumes_cpu(scene, unit_grid(n));
    EXPECT_EQ(cells.occupancy->activeVoxelCount(), std::uint64_t(n * n * n - (n - 2) * (n - 2) * (n - 2)));
    for (auto it = cells.occupancy->cbeginValueOn(); it; ++it) EXPECT_EQ(*it, 1.0f);
    const openvdb::Vec3d first = cells.occupancy->transform().indexToWorld(openvdb::Coord(0, 0, 0));
    EXPECT_NEAR(first[0], 9.0 + 1.0 / n, 1e-6);
  }
}

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
  for (float least_cosine : {0.70710678f, 0.0f}) {
    for (int a = 0; a < 3; ++a) {
      const int b = shared::axis_b(a), c = shared::axis_c(a);
      if (std::abs(n[a]) < 1e-3f) continue;
      out.sides[a] = -1;
      for (int k = 0; k < 27 && out.sides[a] < 0; ++k) {
        glm::ivec3 cell(glm::floor(point));
        cell[b] += order[k / 3] % 3 - 1;
        cell[c] += order[k / 3] / 3 - 1;
        const float depth =
            point[a] + (n[b] * (point[b] - float(cell[b]) - 0.5f) + n[c] * (point[c] - float(cell[c]) - 0.5f)) / n[a];
        if (std::abs(depth - point[a]) > 3.0f) continue;
        cell[a] = shared::face_of_depth(depth) + (k % 3 == 2 ? -1 : k % 3) - (n[a] > 0.0f ? 0 : 1);
        if (!shared::cell_inside(v.grid(), cell)) continue;
        const Side* side = side_of(v, cell, shared::face_of(a, !(n[a] > 0.0f)));
        if (side == nullptr || (front >= 0 && side->front != front)) continue;
        const float cosine = glm::dot(side->normal, n), bounded = glm::clamp(cosine, 0.1f, 1.0f);
        const float behind = (side->depth - depth) * side->normal[a];
        if (front >= 0 && behind > 0.02f + 0.75f * std::sqrt(1.0f - bounded * bounded) / bounded) continue;
        if (cosine >= least_cosine) out.sides[a] = int(side - v.sides().data());
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

}  // namespace
}  // namespace volgi::test
