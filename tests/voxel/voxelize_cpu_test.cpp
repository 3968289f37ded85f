#include "voxel/voxelize_cpu.h"

#include <gtest/gtest.h>
#include <openvdb/openvdb.h>
#include <tbb/global_control.h>

#include <cstring>

#include "core/surface.h"
#include "tests/support/volume_scenes.h"
#include "tests/voxel/cpu_voxels.h"

namespace volgi::test {
namespace {

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
  for (int i = 0; i < 8; ++i)
    image.rgba.edit().insert(image.rgba.edit().end(), {255, 255, 255, std::uint8_t(i < 4 ? 0 : 255)});
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
  int found = 0, same = 0;
  for (const Side& side : a.sides()) {
    const glm::ivec3 c = shared::cell_coord(a.grid(), side.cell);
    const int face = (side.face + 2) % 6;
    const Side* other = side_of(b, {c.z, c.x, c.y}, face);
    if (other == nullptr) continue;
    ++found;
    same += std::abs(other->coverage - side.coverage) < 1e-6f && other->front == side.front &&
            std::abs(other->area_m2 - side.area_m2) < 1e-3f * side.area_m2;
  }
  const double found_share = double(found) / double(a.side_count()), same_share = double(same) / double(a.side_count());
  EXPECT_GE(found_share, 0.999);
  EXPECT_GT(same_share, 0.99);  // ties go another way
  RecordProperty("shares", std::to_string(found_share) + " " + std::to_string(same_share));
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

// What lies below a block's first face, but nearer to it than half a cell, is rasterized with the block above.
TEST(CellVolumesCpu, WallsBelowABlockAreInItsNeighbour) {
  const Grid grid = unit_grid(16);
  for (int axis = 0; axis < 3; ++axis) {
    glm::vec3 centre(0.0f), normal(0.0f);
    centre[axis] = -0.2f * grid.cell_size_m;  // 7.8 cells
    normal[axis] = 1.0f;
    Scene scene;
    add_square(scene, add_material(scene, kRed), centre, normal, 2.0f);
    const CellVolumes cells = cell_volumes_cpu(scene, grid);
    EXPECT_EQ(cells.occupancy->activeVoxelCount(), 256u);
    for (auto it = cells.occupancy->cbeginValueOn(); it; ++it) EXPECT_EQ(it.getCoord()[size_t(axis)], 7);
  }
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

}  // namespace
}  // namespace volgi::test
