// What emitters send into the volume is exact: pi L_e times area, however small or oblique they are.
#include "voxel/emitter_pieces.h"

#include <gtest/gtest.h>

#include "tests/support/volume_scenes.h"

namespace volgi::test {
namespace {

const glm::vec3 kRadiance(3.0f, 2.0f, 0.5f);

glm::dvec3 sum_of(const std::vector<FluxSample>& pieces) {
  glm::dvec3 sum(0.0);
  for (const FluxSample& p : pieces) sum += glm::dvec3(p.flux);
  return sum;
}

void expect_exact(const Scene& scene, const Grid& grid, double sides = 1.0) {
  const std::vector<FluxSample> pieces = emitter_pieces(scene, grid);
  const glm::dvec3 sum = sum_of(pieces);
  for (int band = 0; band < 3; ++band) {
    const double exact = glm::pi<double>() * double(kRadiance[band]) * area(scene) * sides;
    EXPECT_NEAR(sum[band] / exact, 1.0, 1e-5);
  }
}

TEST(EmitterPieces, TriangleInsideOneCell) {
  Scene scene;
  Mesh& mesh = add_quad(scene, add_material(scene, glm::vec3(0.0f), kRadiance), {0.01f, 0.02f, 0.01f}, {0.02f, 0, 0},
                        {0, 0.01f, 0.015f});
  mesh.triangles.resize(1);
  EXPECT_EQ(emitter_pieces(scene, unit_grid(8)).size(), 1u);
  expect_exact(scene, unit_grid(8));
}

TEST(EmitterPieces, QuadOverManyColumns) {
  Scene scene;
  add_quad(scene, add_material(scene, glm::vec3(0.0f), kRadiance), {-0.93f, 0.31f, -0.87f}, {0, 0, 1.71f},
           {1.8f, 0, 0});
  const Grid grid = unit_grid(32);
  expect_exact(scene, grid);
  for (const FluxSample& p : emitter_pieces(scene, grid)) {
    EXPECT_NEAR(p.position.y, 0.31f, 1e-6f);
    EXPECT_NEAR(p.normal.y, 1.0f, 1e-6f);
    // No piece is larger than its column.
    EXPECT_LE(p.flux.x, 1.00001f * glm::pi<float>() * kRadiance.x * grid.cell_size_m * grid.cell_size_m);
  }
}

TEST(EmitterPieces, TiltedAndBeyondTheGrid) {
  const int grids[] = {1, 7, 24};
  for (int n : grids) {
    Scene scene;
    const int glow = add_material(scene, glm::vec3(0.2f), kRadiance);
    add_square(scene, glow, {0.1f, -0.2f, 0.05f}, {1.0f, 2.0f, -0.7f}, 0.6f);
    add_square(scene, glow, {0.0f, 0.0f, 0.0f}, {1.0f, -1.0f, 1.0f}, 0.5f);
    add_square(scene, glow, {0.9f, 0.9f, 0.9f}, {0.0f, 0.1f, 1.0f}, 0.4f);
    expect_exact(scene, unit_grid(n));
  }
}

TEST(EmitterPieces, DoubleSidedSendsTwice) {
  Scene scene;
  add_square(scene, add_material(scene, glm::vec3(0.2f), kRadiance), {0.1f, -0.2f, 0.05f}, {1.0f, 2.0f, -0.7f}, 0.6f);
  scene.materials[0].double_sided = true;
  expect_exact(scene, unit_grid(16), 2.0);
  glm::dvec3 balance(0.0);
  for (const FluxSample& p : emitter_pieces(scene, unit_grid(16))) balance += glm::dvec3(p.normal * p.flux.x);
  EXPECT_NEAR(glm::length(balance), 0.0, 1e-5);
}

TEST(EmitterPieces, BlendedEmitterSendsItsCoverage) {
  Scene scene;
  add_square(scene, add_material(scene, glm::vec3(0.2f), kRadiance), {0.1f, -0.2f, 0.05f}, {0.0f, 1.0f, 0.0f}, 0.6f);
  scene.materials[0].alpha_mode = AlphaMode::blend;
  scene.materials[0].base_color_factor.a = 0.25f;
  expect_exact(scene, unit_grid(16), 0.25);
}

TEST(EmitterPieces, NothingFromWhatDoesNotEmit) {
  Scene scene;
  add_square(scene, add_material(scene, glm::vec3(0.9f)), glm::vec3(0.0f), {0.0f, 1.0f, 0.0f}, 0.6f);
  EXPECT_TRUE(emitter_pieces(scene, unit_grid(16)).empty());
  Scene flat;  // no area, no light
  add_quad(flat, add_material(flat, glm::vec3(0.9f), kRadiance), glm::vec3(0.0f), {1.0f, 0.0f, 0.0f},
           {0.5f, 0.0f, 0.0f});
  EXPECT_TRUE(emitter_pieces(flat, unit_grid(16)).empty());
}

// Texture half bright, half dark, with the boundary off the grid: pieces sample it at five points each.
TEST(EmitterPieces, TexturedEmitterSendsTheMean) {
  Scene scene;
  add_quad(scene, add_material(scene, glm::vec3(0.0f), kRadiance), {-0.9f, 0.3f, -0.9f}, {0, 0, 1.8f}, {1.8f, 0, 0});
  TextureImage image{8, 8, {}};
  for (int i = 0; i < 64; ++i) {
    const std::uint8_t v = (i % 8) < 3 ? 255 : 0;
    image.rgba.edit().insert(image.rgba.edit().end(), {v, v, v, 255});
  }
  scene.images.push_back(image);
  scene.textures.push_back({0, {}});
  scene.materials[0].emissive.texture = 0;
  const double exact = glm::pi<double>() * double(kRadiance.x) * area(scene) * 3.0 / 8.0;
  EXPECT_NEAR(sum_of(emitter_pieces(scene, unit_grid(32))).x / exact, 1.0, 0.02);
}

}  // namespace
}  // namespace volgi::test
