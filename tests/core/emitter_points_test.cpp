// Points on textured emitters: where they lie, and what they are good for.
#include "core/emitter_points.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/constants.hpp>

namespace volgi::test {
namespace {

constexpr int TEXELS = 30;
constexpr glm::dvec2 SCREEN(1.6, 0.9);

/// A screen in the plane z = 0 that faces +Z, black but for three by three of its texels: one per cent.
Scene black_screen_with_a_bright_square() {
  Scene scene;
  TextureImage image{TEXELS, TEXELS, std::vector<std::uint8_t>(size_t(TEXELS) * TEXELS * 4, 0)};
  for (size_t y = 0; y < TEXELS; ++y) {
    for (size_t x = 0; x < TEXELS; ++x) {
      std::uint8_t* p = &image.rgba.edit()[4 * (TEXELS * y + x)];
      const bool bright = x >= 10 && x < 13 && y >= 4 && y < 7;
      p[0] = p[1] = p[2] = bright ? 255 : 0;
      p[3] = 255;
    }
  }
  scene.images = {image};
  scene.textures.resize(1);
  scene.textures[0].image = 0;
  scene.textures[0].sampler.magnify_nearest = true;
  Material material;
  material.emissive_radiance = glm::vec3(100.0f);
  material.emissive.texture = 0;
  scene.materials = {material};
  Mesh mesh;
  const auto [w, h] = std::pair(float(SCREEN.x), float(SCREEN.y));
  mesh.positions = {{0, 0, 0}, {w, 0, 0}, {w, h, 0}, {0, h, 0}};
  mesh.normals.assign(4, {0, 0, 1});
  mesh.uv[0] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  scene.meshes = {mesh};
  return scene;
}

/// On a floor under the screen, of lights as disks on their axes (docs/conventions.md#virtual-lights).
double irradiance_on_floor(const std::vector<EmitterPoint>& points, glm::dvec3 at) {
  double sum = 0.0;
  for (const EmitterPoint& p : points) {
    const glm::dvec3 w = glm::dvec3(p.position) - at;
    const double d2 = glm::dot(w, w), height = -glm::dot(w, glm::dvec3(p.normal));
    if (height > 0.0 && w.y > 0.0)
      sum += double(p.flux.x) * height * w.y / d2 / (glm::pi<double>() * d2 + double(p.area_m2));
  }
  return sum;
}

double exact_on_floor(glm::dvec3 at) {
  constexpr int N = 60;
  const glm::dvec2 texel = SCREEN / double(TEXELS), low(10 * texel.x, SCREEN.y - 7 * texel.y), size = 3.0 * texel;
  double sum = 0.0;
  for (int j = 0; j < N; ++j) {
    for (int i = 0; i < N; ++i) {
      const glm::dvec2 on = low + size * (glm::dvec2(i, j) + 0.5) / double(N);
      const glm::dvec3 w = glm::dvec3(on, 0.0) - at;
      const double d2 = glm::dot(w, w);
      sum += 100.0 * -w.z * w.y / (d2 * d2) * size.x * size.y / double(N * N);
    }
  }
  return sum;
}

/// Root mean square of the relative error over a floor half a metre below.
double error_of(const std::vector<EmitterPoint>& points) {
  double sum = 0.0;
  constexpr int N = 12;
  for (int j = 0; j < N; ++j) {
    for (int i = 0; i < N; ++i) {
      const glm::dvec3 at(1.6 * (i + 0.5) / N, -0.5, 0.1 + 1.5 * (j + 0.5) / N);
      const double exact = exact_on_floor(at);
      sum += std::pow(irradiance_on_floor(points, at) / exact - 1.0, 2.0);
    }
  }
  return std::sqrt(sum / (N * N));
}

// Nichols 2010, Fig. 5.15: lights on an even grid waste themselves on what is black.
TEST(EmitterPoints, OnABlackScreenWithABrightSquareStandOnTheSquare) {
  const Scene scene = black_screen_with_a_bright_square();
  const EmitterPoints emitters(scene);
  const double grid = error_of(emitters.grid_points(256)), importance = error_of(emitters.points(256));
  RecordProperty("grid", std::to_string(grid));
  RecordProperty("importance", std::to_string(importance));
  EXPECT_LT(importance, 0.5 * grid);
  EXPECT_LT(importance, 0.02);  // strata of a quarter of the square each, cut from a curve
  int bright = 0;
  for (const EmitterPoint& p : emitters.points(256)) bright += p.flux.x > 0.0f ? 1 : 0;
  EXPECT_GT(bright, 256 * 8 / 10);  // a tenth and more of them go by area
}

TEST(EmitterPoints, AGridHasRowsAndColumnsAndAllThePower) {
  const Scene scene = black_screen_with_a_bright_square();
  const EmitterPoints emitters(scene);
  const std::vector<EmitterPoint> points = emitters.grid_points(256);
  ASSERT_EQ(points.size(), 256u);
  double flux = 0.0;
  for (size_t k = 0; k < points.size(); ++k) {
    // Cell (i, j), from whichever corner it is counted, has its middle at an odd number of half cells.
    const glm::dvec2 cells = 16.0 * glm::dvec2(points[k].position) / SCREEN - 0.5;
    EXPECT_NEAR(cells.x, std::round(cells.x), 1e-4);
    EXPECT_NEAR(cells.y, std::round(cells.y), 1e-4);
    EXPECT_NEAR(double(points[k].area_m2), SCREEN.x * SCREEN.y / 256.0, 1e-6);
    flux += double(points[k].flux.x);
  }
  // 4 x 4 looks at each cell: of the square's edge of 6.4 looks, one may be missed or too many.
  EXPECT_NEAR(flux, emitters.flux().x, 0.3 * emitters.flux().x);
}

}  // namespace
}  // namespace volgi::test
