#include "voxel/sliced_voxelization.h"

#include <gtest/gtest.h>

#include <cstring>

#include "core/surface.h"
#include "tests/support/gl_test.h"
#include "tests/support/volume_scenes.h"
#include "tests/support/voxels.h"

namespace volgi::test {
namespace {

class SlicedVoxels : public GlTest {};

const glm::vec3 kRed(0.8f, 0.1f, 0.2f);
const glm::vec3 kBlue(0.1f, 0.3f, 0.7f);

TEST_F(SlicedVoxels, WallOnAxisBlocksOneFaceAColumn) {
  Scene scene;
  add_square(scene, add_material(scene, kRed), {0.3f, 0.0f, 0.0f}, {1.0f, 0.0f, 0.0f}, 2.0f);
  const Voxels v = voxelize(context(), scene, unit_grid(16));
  ASSERT_EQ(v.sides.size(), 2u * 16 * 16);
  const int left = 9;  // 0.3 is at 10.4 cells, between the centres of the cells 9 and 10
  for (const Side& side : v.sides) {
    const glm::ivec3 c = shared::cell_coord(v.grid, side.cell);
    EXPECT_EQ(shared::face_axis(side.face), 0);
    EXPECT_EQ(c.x, side.face == 1 ? left : left + 1);
    EXPECT_EQ(side.normal, glm::vec3(side.face == 1 ? -1.0f : 1.0f, 0.0f, 0.0f));
    EXPECT_EQ(side.coverage, 1.0f);
    EXPECT_NEAR(side.area_m2, 1.0f / 64.0f, 1e-6f);
    EXPECT_NEAR(side.face_m2, 1.0f / 64.0f, 1e-7f);
    EXPECT_EQ(side.front, side.face == 0 ? 1 : 0);
    EXPECT_NEAR(side.depth, 10.4f, 0.01f);
    for (int band = 0; band < 3; ++band) EXPECT_NEAR(side.albedo[band], kRed[band], 1e-6f);
    EXPECT_EQ(side.radiosity, glm::vec3(0.0f));
    EXPECT_EQ(v.side(c, side.face), &side);
    EXPECT_TRUE(shared::is_opaque(v.cell(c), side.face));
  }
}

TEST_F(SlicedVoxels, SidesFaceTheCellThatSeesThem) {
  Scene scene;
  const int grey = add_material(scene, glm::vec3(0.5f));
  add_sphere_inside(scene, grey, {0.1f, 0.0f, -0.05f}, 0.6f, 12);
  add_square(scene, grey, {0.0f, 0.0f, 0.0f}, {1.0f, -2.0f, 0.5f}, 0.4f);
  const Voxels v = voxelize(context(), scene, unit_grid(20));
  ASSERT_GT(v.sides.size(), 1000u);
  for (size_t i = 0; i < v.sides.size(); ++i) {
    const Side& side = v.sides[i];
    EXPECT_LT(side.normal[shared::face_axis(side.face)] * float(shared::face_sign(side.face)), 0.0f);
    EXPECT_NEAR(glm::length(side.normal), 1.0f, 1e-5f);
    EXPECT_NEAR(side.face_m2, side.coverage * v.grid.cell_size_m * v.grid.cell_size_m, 1e-8f);
    EXPECT_GT(side.area_m2, 0.0f);
    // The surface lies between the centre of the cell and that of its neighbour; one that covers a part of the face may
    // pass beside them.
    const glm::ivec3 c = shared::cell_coord(v.grid, side.cell);
    const float ahead =
        (side.depth - float(c[shared::face_axis(side.face)]) - 0.5f) * float(shared::face_sign(side.face));
    if (side.coverage == 1.0f) {
      EXPECT_GT(ahead, -0.01f);
      EXPECT_LT(ahead, 1.01f);
    }
    EXPECT_EQ(shared::side_index(v.cell(c), side.face), i);
  }
}

// Two sheets 2 cm apart between the same cell centres: each cell sees the sheet on its own side.
TEST_F(SlicedVoxels, SheetsOfAThinWallKeepTheirAlbedo) {
  for (glm::vec3 direction : {glm::vec3(1, 0, 0), glm::vec3(0, 0, -1), glm::vec3(1, 1, 0), glm::vec3(2, -1, 1)}) {
    const glm::vec3 normal = glm::normalize(direction);
    Scene scene;
    add_square(scene, add_material(scene, kRed), 0.003f * normal, -normal, 4.0f);
    add_square(scene, add_material(scene, kBlue), 0.023f * normal, normal, 4.0f);
    const Voxels v = voxelize(context(), scene, unit_grid(16));
    int wrong = 0, inside = 0;
    for (const Side& side : v.sides) {
      const glm::vec3 centre = v.centre(shared::cell_coord(v.grid, side.cell));
      const float distance = glm::dot(centre, normal);
      if (distance > 0.002f && distance < 0.024f) {
        ++inside;  // cells whose centre is in the wall see the inner sides
        continue;
      }
      const glm::vec3 expected = distance < 0.01f ? kRed : kBlue;
      wrong += glm::distance(side.albedo, expected) > 1e-5f;
      EXPECT_EQ(glm::dot(side.normal, normal) > 0.0f, distance > 0.01f);
    }
    EXPECT_EQ(wrong, 0) << "normal " << direction.x << ' ' << direction.y << ' ' << direction.z;
    EXPECT_LT(inside, int(v.sides.size()) / 4);
  }
}

/// Areas that the sides on one face of a surface stand for.
double area_in_front(const Voxels& v, glm::vec3 normal) {
  double sum = 0.0;
  for (const Side& side : v.sides) sum += glm::dot(side.normal, normal) > 0.0f ? double(side.area_m2) : 0.0;
  return sum;
}

TEST_F(SlicedVoxels, AreasOfTiltedSquares) {
  SlicedVoxelization voxelization(unit_grid(32));
  double sum = 0.0, worst = 0.0;
  int count = 0;
  for (int i = 0; i < 24; ++i) {
    // Spread over the sphere (Fibonacci), so that the mean is one over orientations.
    const float z = (float(i) + 0.5f) / 24.0f;
    const float phi = 2.399963f * float(i);
    const glm::vec3 normal(std::sqrt(1.0f - z * z) * std::cos(phi), std::sqrt(1.0f - z * z) * std::sin(phi), z);
    Scene scene;
    add_square(scene, add_material(scene, kRed), {0.01f, -0.02f, 0.017f}, normal, 0.5f);
    const double ratio = area_in_front(voxelize(context(), voxelization, scene), normal);  // the square has 1 m^2
    sum += ratio;
    worst = std::max(worst, std::abs(ratio - 1.0));
    ++count;
  }
  EXPECT_NEAR(sum / count, 1.0, 0.005);
  EXPECT_LT(worst, 0.022);  // 16 cells wide, counted by thirds of a cell at the rim: 2.1 %
  RecordProperty("mean_ratio", std::to_string(sum / count));
  RecordProperty("worst", std::to_string(worst));
}

TEST_F(SlicedVoxels, AreasOfASphere) {
  Scene scene;
  add_sphere_inside(scene, add_material(scene, kRed), {0.003f, 0.011f, -0.007f}, 0.85f, 32);
  const Voxels v = voxelize(context(), scene, unit_grid(32));
  double inner = 0.0, outer = 0.0;
  for (const Side& side : v.sides) {
    const glm::vec3 c = v.centre(shared::cell_coord(v.grid, side.cell));
    (glm::dot(side.normal, c) < 0.0f ? inner : outer) += double(side.area_m2);
  }
  EXPECT_NEAR(inner / area(scene), 1.0, 0.012);
  EXPECT_NEAR(outer / area(scene), 1.0, 0.012);
  RecordProperty("inner", std::to_string(inner / area(scene)));
}

TEST_F(SlicedVoxels, BlendCoversAShare) {
  Scene scene;
  const int glass = add_material(scene, kRed);
  scene.materials[0].alpha_mode = AlphaMode::blend;
  scene.materials[0].base_color_factor.a = 0.3f;
  add_square(scene, glass, {0.3f, 0.0f, 0.0f}, {1.0f, 0.0f, 0.0f}, 2.0f);
  const Grid grid = unit_grid(8);
  const Voxels one = voxelize(context(), scene, grid);
  ASSERT_EQ(one.sides.size(), 2u * 64);
  for (const Side& side : one.sides) {
    EXPECT_NEAR(side.coverage, 0.3f, 1e-4f);
    EXPECT_NEAR(side.area_m2, 0.3f / 16.0f, 1e-5f);
    EXPECT_FALSE(shared::is_opaque(one.cells[size_t(side.cell)], side.face));
  }
  add_square(scene, glass, {0.31f, 0.0f, 0.0f}, {1.0f, 0.0f, 0.0f}, 2.0f);  // the same face: 1 - 0.7^2
  for (const Side& side : voxelize(context(), scene, grid).sides) EXPECT_NEAR(side.coverage, 0.51f, 1e-4f);
  scene.materials[0].base_color_factor.a = 1.0f;
  const Voxels opaque = voxelize(context(), scene, grid);
  for (const Side& side : opaque.sides) EXPECT_TRUE(shared::is_opaque(opaque.cells[size_t(side.cell)], side.face));
}

// Next to nothing must not disturb the list of sides.
TEST_F(SlicedVoxels, BlendOfAlmostNothing) {
  Scene scene;
  add_square(scene, add_material(scene, kBlue), {0.0f, 0.05f, 0.0f}, {0.0f, 1.0f, 0.0f}, 2.0f);
  const Voxels alone = voxelize(context(), scene, unit_grid(8));
  const int haze = add_material(scene, kRed);
  scene.materials[size_t(haze)].alpha_mode = AlphaMode::blend;
  scene.materials[size_t(haze)].base_color_factor.a = 1e-6f;
  add_square(scene, haze, {0.0f, 0.0f, 0.0f}, {0.01f, 0.02f, 1.0f}, 2.0f);  // the last axis that is sliced
  const Voxels v = voxelize(context(), scene, unit_grid(8));
  int blue = 0;
  for (const Side& side : v.sides) {
    if (side.coverage < 0.5f) continue;
    EXPECT_EQ(shared::face_axis(side.face), 1);
    EXPECT_EQ(v.side(shared::cell_coord(v.grid, side.cell), side.face), &side);
    blue += glm::distance(side.albedo, kBlue) < 1e-5f;
  }
  EXPECT_EQ(blue, int(alone.sides.size()));
}

TEST_F(SlicedVoxels, MaskCuts) {
  Scene scene;
  add_square(scene, add_material(scene, kRed), {0.3f, 0.0f, 0.0f}, {1.0f, 0.0f, 0.0f}, 1.0f);
  scene.materials[0].alpha_mode = AlphaMode::mask;
  scene.materials[0].base_color_factor.a = 0.6f;
  EXPECT_EQ(voxelize(context(), scene, unit_grid(8)).sides.size(), 2u * 64);
  scene.materials[0].base_color_factor.a = 0.4f;
  EXPECT_EQ(voxelize(context(), scene, unit_grid(8)).sides.size(), 0u);
  // A texture whose left half is cut away.
  TextureImage image{8, 1, {}};
  for (int i = 0; i < 8; ++i)
    image.rgba.edit().insert(image.rgba.edit().end(), {255, 255, 255, std::uint8_t(i < 4 ? 0 : 255)});
  scene.images.push_back(image);
  scene.textures.push_back({0, {Wrap::clamp_to_edge, Wrap::clamp_to_edge, true, true, false, false}});
  scene.materials[0].base_color.texture = 0;
  scene.materials[0].base_color_factor.a = 1.0f;
  const Voxels half = voxelize(context(), scene, unit_grid(8));
  EXPECT_EQ(half.sides.size(), 2u * 32);
  for (const Side& side : half.sides) EXPECT_EQ(side.coverage, 1.0f);
}

TEST_F(SlicedVoxels, TexturedWallHasTheMeanOfItsTexture) {
  Scene scene;
  add_square(scene, add_material(scene, glm::vec3(1.0f, 0.5f, 1.0f)), {0.3f, 0.0f, 0.0f}, {1.0f, 0.0f, 0.0f}, 1.0f);
  TextureImage image{64, 64, {}};
  std::uint32_t state = 1;
  const auto random = [&] { return std::uint8_t((state = state * 1664525u + 1013904223u) >> 24); };
  for (int i = 0; i < 64 * 64; ++i)
    image.rgba.edit().insert(image.rgba.edit().end(), {random(), random(), random(), 255});
  scene.images.push_back(image);
  scene.textures.push_back({0, {}});
  scene.materials[0].base_color.texture = 0;
  glm::dvec3 mean(0.0), sides(0.0);
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      mean += glm::dvec3(sample_texture(scene, 0, (glm::vec2(x, y) + 0.5f) / 64.0f, true)) * glm::dvec3(1.0, 0.5, 1.0) /
              4096.0;
    }
  }
  const Voxels v = voxelize(context(), scene, unit_grid(16));
  ASSERT_EQ(v.sides.size(), 2u * 256);
  for (const Side& side : v.sides) sides += glm::dvec3(side.albedo) / double(v.sides.size());
  for (int band = 0; band < 3; ++band) EXPECT_NEAR(sides[band] / mean[band], 1.0, 0.02);
}

TEST_F(SlicedVoxels, EmissionIsOneSided) {
  const glm::vec3 radiance(2.0f, 1.0f, 0.0f);
  Scene scene;
  add_square(scene, add_material(scene, kRed, radiance), {0.3f, 0.0f, 0.0f}, {1.0f, 1.0f, 0.0f}, 2.0f);
  const Voxels v = voxelize(context(), scene, unit_grid(8));
  ASSERT_FALSE(v.sides.empty());
  for (const Side& side : v.sides) {
    const glm::vec3 expected = side.normal.x > 0.0f ? glm::pi<float>() * radiance : glm::vec3(0.0f);
    EXPECT_LT(glm::distance(side.radiosity, expected), 1e-5f);
  }
  scene.materials[0].double_sided = true;
  for (const Side& side : voxelize(context(), scene, unit_grid(8)).sides) {
    EXPECT_LT(glm::distance(side.radiosity, glm::pi<float>() * radiance), 1e-5f);
  }
}

TEST_F(SlicedVoxels, SameInputSameBytes) {
  Scene scene;
  add_sphere_inside(scene, add_material(scene, kRed), {0.0f, 0.1f, 0.0f}, 0.8f, 24);
  add_square(scene, add_material(scene, kBlue), {0.3f, 0.0f, 0.0f}, {1.0f, 1.0f, 0.3f}, 0.7f);
  add_square(scene, add_material(scene, glm::vec3(0.1f)), {0.3f, 0.0f, 0.0f}, {1.0f, 1.0f, 0.3f},
             0.7f);  // the same place
  const Voxels a = voxelize(context(), scene, unit_grid(24));
  const Voxels b = voxelize(context(), scene, unit_grid(24));
  ASSERT_EQ(a.sides.size(), b.sides.size());
  EXPECT_EQ(std::memcmp(a.sides.data(), b.sides.data(), a.sides.size() * sizeof(Side)), 0);
  EXPECT_EQ(std::memcmp(a.cells.data(), b.cells.data(), a.cells.size() * sizeof(glm::uvec2)), 0);
}

// A scene that grows by more than the room there is: one frame may leave sides out, the third must not.
TEST_F(SlicedVoxels, ListOfSidesGrows) {
  SlicedVoxelization voxelization(unit_grid(24));
  Scene small;
  add_square(small, add_material(small, kRed), glm::vec3(0.0f), {0.0f, 1.0f, 0.0f}, 0.2f);
  const size_t few = voxelize(context(), voxelization, small).sides.size();
  Scene large;
  add_sphere_inside(large, add_material(large, kRed), glm::vec3(0.0f), 0.8f, 24);
  const Voxels grown = voxelize(context(), voxelization, large);
  const Voxels fresh = voxelize(context(), large, unit_grid(24));
  EXPECT_GT(fresh.sides.size(), 2 * few);
  ASSERT_EQ(grown.sides.size(), fresh.sides.size());
  EXPECT_EQ(std::memcmp(grown.sides.data(), fresh.sides.data(), fresh.sides.size() * sizeof(Side)), 0);
}

}  // namespace
}  // namespace volgi::test
