// Halton points, the directions made of them, and points on emissive surfaces.
#include "core/halton.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/emitter_points.h"

namespace volgi::test {
namespace {

TEST(Halton, DigitsAreMirrored) {
  const std::vector<double> base2 = {0.5, 0.25, 0.75, 0.125, 0.625, 0.375, 0.875, 0.0625};
  const std::vector<double> base3 = {1. / 3, 2. / 3, 1. / 9, 4. / 9, 7. / 9, 2. / 9, 5. / 9, 8. / 9};
  for (size_t i = 0; i < 8; ++i) {
    EXPECT_DOUBLE_EQ(halton(i + 1).x, base2[i]);
    EXPECT_DOUBLE_EQ(halton(i + 1).y, base3[i]);
  }
  EXPECT_EQ(radical_inverse(3, 0), 0.0);
}

double height_of(double angle_deg) { return 2.0 * std::pow(std::sin(0.5 * glm::radians(angle_deg)), 2.0); }

// The paper's rejection, point by point: the indices that are skipped must be those that it rejects.
TEST(Halton, ConesHoldTheFirstPointsOfTheSphereInThem) {
  for (const double angle_deg : {179.0, 90.0, 30.0, 5.0, 1.0}) {
    const double height = height_of(angle_deg);
    const std::vector<glm::vec3> found = halton_directions_in_cone(height, 100);
    ASSERT_EQ(found.size(), 100u);
    size_t next = 0;
    for (std::uint64_t i = 1; next < found.size(); ++i) {
      ASSERT_LT(i, 10'000'000u);
      const glm::dvec2 xi = halton(i);
      const double sine = 2.0 * xi.y - 1.0;
      if (sine < 1.0 - height) continue;
      const double phi = 2.0 * glm::pi<double>() * xi.x;
      const double cosine = std::sqrt(1.0 - sine * sine);
      EXPECT_NEAR(found[next].x, cosine * std::sin(phi), 1e-6);
      EXPECT_NEAR(found[next].y, -sine, 1e-6);
      EXPECT_NEAR(found[next].z, cosine * std::cos(phi), 1e-6);
      ++next;
    }
  }
}

// Quarters of a cone about its axis, and the inner half of its solid angle: random points would miss by 1 / sqrt(N).
TEST(Halton, DirectionsAreEvenInTheCone) {
  constexpr int count = 1024;
  for (const double angle_deg : {180.0, 60.0, 20.0, 0.2}) {
    const double height = height_of(angle_deg);
    int quarter[4] = {};
    int inner = 0;
    for (const glm::vec3 d : halton_directions_in_cone(height, count)) {
      const double across = std::hypot(double(d.x), double(d.z));
      const double angle = std::atan2(across, -double(d.y));
      EXPECT_NEAR(glm::length(d), 1.0f, 1e-6f);
      EXPECT_LE(angle, glm::radians(angle_deg) * (1.0 + 1e-6));
      ++quarter[(d.x > 0.0f ? 1 : 0) + (d.z > 0.0f ? 2 : 0)];
      inner += 2.0 * std::pow(std::sin(0.5 * angle), 2.0) < 0.5 * height ? 1 : 0;
    }
    for (const int q : quarter) EXPECT_NEAR(q, 0.25 * count, 8) << angle_deg;
    EXPECT_NEAR(inner, 0.5 * count, 8) << angle_deg;
  }
}

/// A rectangle of 2 x 1 m in the plane y = 0, front side up; two triangles.
Scene glowing_rectangle(glm::vec3 radiance) {
  Scene scene;
  Material material;
  material.emissive_radiance = radiance;
  scene.materials = {material};
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {0, 0, 1}, {2, 0, 1}, {2, 0, 0}};
  mesh.normals.assign(4, {0, 1, 0});
  mesh.uv[0] = {{0, 0}, {0, 1}, {1, 1}, {1, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  scene.meshes = {mesh};
  return scene;
}

glm::dvec3 sum_of_flux(const std::vector<EmitterPoint>& points) {
  glm::dvec3 sum(0.0);
  for (const EmitterPoint& p : points) sum += glm::dvec3(p.flux);
  return sum;
}

void expect_near(glm::dvec3 value, glm::dvec3 expected, double relative) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(value[c], expected[c], relative * expected[c] + 1e-12) << c;
}

TEST(EmitterPoints, CarryThePowerOfTheirSurface) {
  const Scene scene = glowing_rectangle({3, 2, 1});
  const EmitterPoints emitters(scene);
  const glm::dvec3 expected = glm::pi<double>() * 2.0 * glm::dvec3(3, 2, 1);
  expect_near(emitters.flux(), expected, 1e-6);
  for (const int count : {1, 7, 512}) {
    const auto points = emitters.points(count);
    ASSERT_EQ(points.size(), size_t(count));
    expect_near(sum_of_flux(points), expected, 1e-5);
    for (const EmitterPoint& p : points) {
      EXPECT_EQ(p.normal, glm::vec3(0, 1, 0));
      EXPECT_NEAR(p.area_m2, 2.0 / count, 1e-5);
      EXPECT_EQ(p.position.y, 0.0f);
    }
  }
  const auto points = emitters.points(512);
  const auto in_corner = [](const EmitterPoint& p) { return p.position.x < 0.5f && p.position.z < 0.5f; };
  EXPECT_NEAR(double(std::count_if(points.begin(), points.end(), in_corner)), 512.0 / 8.0, 6);
}

TEST(EmitterPoints, DoubleSidedOnesSendFromBothSides) {
  Scene scene = glowing_rectangle({3, 2, 1});
  scene.materials[0].double_sided = true;
  const EmitterPoints emitters(scene);
  const auto points = emitters.points(256);
  expect_near(sum_of_flux(points), 4.0 * glm::pi<double>() * glm::dvec3(3, 2, 1), 1e-5);
  const auto faces_up = [](const EmitterPoint& p) { return p.normal.y > 0.0f; };
  EXPECT_EQ(std::count_if(points.begin(), points.end(), faces_up), 128);
  double area = 0.0;
  for (const EmitterPoint& p : points) area += double(p.area_m2);
  EXPECT_NEAR(area, 4.0, 1e-4);
}

// Sixteen that follow on each other are the sub-lights of one virtual light: a piece of surface, not points all over
// it.
TEST(EmitterPoints, ThoseThatFollowOnEachOtherAreNear) {
  const Scene scene = glowing_rectangle({3, 2, 1});  // of 2 square metres
  constexpr int count = 4096, run = 16;
  const auto points = EmitterPoints(scene).points(count);
  double spread = 0.0;
  for (size_t first = 0; first < points.size(); first += run) {
    glm::dvec3 mean(0.0);
    for (size_t i = first; i < first + run; ++i) mean += glm::dvec3(points[i].position) / double(run);
    for (size_t i = first; i < first + run; ++i)
      spread += glm::dot(glm::dvec3(points[i].position) - mean, glm::dvec3(points[i].position) - mean);
  }
  // A square of area a has the mean square radius a / 6; all of a triangle, a few tenths.
  EXPECT_LT(spread / count, 4.0 / 6.0 * 2.0 * run / count);
}

TEST(EmitterPoints, TexturesAndCoverageCount) {
  Scene scene = glowing_rectangle({4, 4, 4});
  TextureImage image{16, 16, std::vector<std::uint8_t>(16 * 16 * 4, 0)};
  for (size_t y = 0; y < 16; ++y) {
    for (size_t x = 0; x < 16; ++x) {
      std::uint8_t* p = &image.rgba.edit()[4 * (16 * y + x)];
      p[0] = x < 4 ? 255 : 0;  // a quarter of the rectangle
      p[1] = 255;
      p[3] = 255;
    }
  }
  scene.images = {image};
  scene.textures.resize(1);
  scene.textures[0].image = 0;
  scene.textures[0].sampler.wrap_s = Wrap::clamp_to_edge;
  scene.textures[0].sampler.magnify_nearest = true;
  scene.materials[0].emissive.texture = 0;
  scene.materials[0].alpha_mode = AlphaMode::blend;
  scene.materials[0].base_color_factor.a = 0.5f;
  const EmitterPoints emitters(scene);
  const glm::dvec3 expected = glm::pi<double>() * 2.0 * 4.0 * 0.5 * glm::dvec3(0.25, 1.0, 0.0);
  expect_near(emitters.flux(), expected, 0.03);
  expect_near(sum_of_flux(emitters.points(4096)), expected, 0.02);
}

TEST(EmitterPoints, DarkSurfacesGetNone) {
  const Scene dark = glowing_rectangle({0, 0, 0});
  EXPECT_TRUE(EmitterPoints(dark).empty());
  EXPECT_TRUE(EmitterPoints(dark).points(5).empty());
  Scene flat = glowing_rectangle({1, 1, 1});
  for (glm::vec3& p : flat.meshes[0].positions) p.z = 0.0f;
  EXPECT_TRUE(EmitterPoints(flat).empty());
}

}  // namespace
}  // namespace volgi::test
