// Direct light against rays through every pixel's centre.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "core/camera.h"
#include "tests/screen/ray_truth.h"
#include "tests/screen/screen_scene.h"
#include "tests/support/gl_test.h"

namespace volgi::test {
namespace {

constexpr glm::ivec2 size(128);

struct Agreement {
  int checked = 0;
  int lit = 0;
  int wrong = 0;
  double worst = 0.0;  // relative
};

/// Pixels without an edge within `reach` pixels; wrong when a channel differs by more than `tolerance` of the truth.
Agreement compare(const Image& image, const TruePicture& truth, int reach, double tolerance = 0.005) {
  Agreement result;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      if (!truth.smooth_around(x, y, reach)) continue;
      const glm::dvec3 expected = truth.at(x, y).radiance;
      const glm::dvec3 difference = glm::abs(glm::dvec3(image.at(x, y)) - expected);
      double error = 0.0;
      for (int c = 0; c < 3; ++c) error = std::max(error, difference[c] / std::max(expected[c], 1e-30));
      if (difference == glm::dvec3(0.0)) error = 0.0;
      ++result.checked;
      result.lit += expected.g > 0.0;
      result.wrong += error > tolerance;
      result.worst = std::max(result.worst, error);
    }
  }
  return result;
}

/// VOLGI_TEST_PICTURES names a folder for the pictures of these tests, to look at them.
void keep_picture(const Image& image) {
  const char* folder = std::getenv("VOLGI_TEST_PICTURES");
  if (folder == nullptr) return;
  const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
  std::string file = std::string(test->test_suite_name()) + "." + test->name() + ".png";
  std::replace(file.begin(), file.end(), '/', '_');
  write_png(std::filesystem::path(folder) / file, image);
}

Agreement check(const gl::Context& context, const Scene& scene, const Camera& camera, int reach) {
  const DirectPicture picture = render_direct(context, scene, camera, size);
  keep_picture(picture.radiance);
  return compare(picture.radiance, true_picture(scene, camera, size), reach);
}

struct LightCase {
  const char* name;
  Light light;
};
std::ostream& operator<<(std::ostream& out, const LightCase& c) { return out << c.name; }

class DirectLight : public GlTest, public ::testing::WithParamInterface<LightCase> {};

TEST_P(DirectLight, AgreesWithRaysOnTheStage) {
  Scene scene = stage();
  scene.lights.push_back(GetParam().light);
  const Agreement a = check(context(), scene, stage_camera(scene), 2);
  EXPECT_GT(a.checked, size.x * size.y / 2);
  EXPECT_GT(a.lit, size.x * size.y / 20);
  EXPECT_EQ(a.wrong, 0) << "worst " << a.worst << " of " << a.checked << " pixels";
}

INSTANTIATE_TEST_SUITE_P(
    Lights, DirectLight,
    ::testing::Values(LightCase{"point", point_light({-0.9f, 2.0f, 1.3f}, 20.0f)},
                      LightCase{"spot", spot_light({1.5f, 2.5f, 1.5f}, {-0.5f, -1, -0.5f}, 15, 35, 30)},
                      LightCase{"wide_spot", spot_light({0, 2.8f, 0.5f}, {0.2f, -1, 0}, 40, 80, 20)},
                      LightCase{"sun", sun_light({-0.6f, -1.0f, -0.4f}, 3.0f)}),
    [](const auto& c) { return c.param.name; });

using Direct = GlTest;

TEST_F(Direct, LightsAddUp) {
  Scene scene = stage();
  scene.lights = {point_light({-0.9f, 2.0f, 1.3f}, 20.0f), sun_light({-0.6f, -1.0f, -0.4f}, 3.0f)};
  const Agreement a = check(context(), scene, stage_camera(scene), 2);
  EXPECT_GT(a.lit, size.x * size.y / 4);
  EXPECT_EQ(a.wrong, 0) << "worst " << a.worst;
}

// Facets of a convex surface next to one another must not shadow each other, nor the sphere's dark side be lit.
TEST_F(Direct, SphereOnAPlane) {
  Scene scene;
  const int grey = add_material(scene, glm::vec3(0.6f));
  add_quad(scene, grey, {-2, 0, -2}, {0, 0, 4}, {4, 0, 0});
  add_sphere(scene, grey, {0.0f, 0.7f, 0.0f}, 0.7f, 16);
  update_bounds(scene);
  for (const Light& light : {sun_light({-1.0f, -1.2f, -0.3f}, 3.0f), point_light({1.4f, 1.9f, 0.8f}, 10.0f),
                             spot_light({1.4f, 1.9f, 0.8f}, {-1.4f, -1.2f, -0.8f}, 30, 40, 10.0f)}) {
    scene.lights = {light};
    const Agreement a = check(context(), scene, stage_camera(scene), 2);
    EXPECT_GT(a.lit, 1000);
    EXPECT_EQ(a.wrong, 0) << "worst " << a.worst << " of " << a.checked << ", light " << int(light.type);
  }
}

// Light almost along the plane: no self-shadow. (An offset along the light, as usual, would need to be 60 times
// larger.)
TEST_F(Direct, GrazingLightLeavesNoAcne) {
  Scene scene;
  const int grey = add_material(scene, glm::vec3(0.6f));
  const glm::vec3 u(0.3f, 0.1f, 4.0f);
  const glm::vec3 v(4.0f, 0.0f, 0.2f);
  add_quad(scene, grey, -0.5f * (u + v), u, v);
  update_bounds(scene);
  const glm::vec3 normal = scene.meshes[0].normals[0];
  const glm::vec3 travel = glm::normalize(glm::normalize(u - v) - std::tan(glm::radians(0.5f)) * normal);
  for (const Light& light : {sun_light(travel, 100.0f), spot_light(-4.0f * travel, travel, 20, 40, 1e3f),
                             point_light(-3.0f * travel, 1e3f)}) {
    scene.lights = {light};
    const Agreement a = check(context(), scene, stage_camera(scene), 1);
    EXPECT_GT(a.lit, 4000);
    EXPECT_EQ(a.wrong, 0) << "worst " << a.worst << " of " << a.checked << ", light " << int(light.type);
  }
}

// The shadow begins where the box stands: every floor pixel beside the contact line, on the side away from the light,
// is dark, and on the light's side none is.
TEST_F(Direct, ShadowBeginsAtTheContact) {
  Scene scene;
  const int grey = add_material(scene, glm::vec3(0.6f));
  add_quad(scene, grey, {-1, 0, -1}, {0, 0, 2}, {2, 0, 0});
  add_box(scene, grey, {0, 0, 0}, {0.6f, 0.3f, 0.6f}, 0.0f);
  update_bounds(scene);
  const Camera close =
      look_at_camera({0.9f, 0.5f, 0.0f}, {0.3f, 0.0f, 0.0f}, 0.12f, scene.bounds_min, scene.bounds_max);
  for (const Light& light : {sun_light({1.0f, -0.8f, 0.0f}, 3.0f), point_light({-0.9f, 1.1f, 0.0f}, 5.0f),
                             spot_light({-0.9f, 1.1f, 0.0f}, {0.9f, -0.9f, 0.0f}, 40, 50, 5.0f)}) {
    scene.lights = {light};
    const TruePicture truth = true_picture(scene, close, size);
    const Image image = render_direct(context(), scene, close, size).radiance;
    keep_picture(image);
    int floor_pixels = 0;
    int leaks = 0;
    for (int y = 0; y < size.y; ++y) {
      for (int x = 0; x < size.x; ++x) {
        const TruePixel& p = truth.at(x, y);
        if (!p.hit || p.mesh != 0 || p.point.position.x > 0.4f || p.point.position.x < 0.3001f) continue;
        ++floor_pixels;
        leaks += image.at(x, y) != glm::vec3(0.0f);
      }
    }
    EXPECT_GT(floor_pixels, 1000);
    EXPECT_EQ(leaks, 0) << "light " << int(light.type);
  }
  const Camera lit_side =
      look_at_camera({-0.9f, 0.5f, 0.0f}, {-0.3f, 0.0f, 0.0f}, 0.12f, scene.bounds_min, scene.bounds_max);
  const Agreement a = check(context(), scene, lit_side, 1);
  EXPECT_GT(a.lit, 8000);
  EXPECT_EQ(a.wrong, 0) << "worst " << a.worst;
}

// A point light in an empty room: the seams between the faces of its map must not show.
TEST_F(Direct, CubeFacesHaveNoSeam) {
  Scene scene;
  const int grey = add_material(scene, glm::vec3(0.5f));
  add_box(scene, grey, {0, -1, 0}, {2, 2, 2}, 0.0f);
  update_bounds(scene);
  scene.lights = {point_light({0.0f, 0.0f, 0.0f}, 1.0f)};
  const Camera camera =
      look_at_camera({-0.9f, 0.8f, 0.9f}, {0.9f, -0.8f, -0.9f}, 1.6f, scene.bounds_min, scene.bounds_max);
  const Agreement a = check(context(), scene, camera, 0);
  EXPECT_EQ(a.lit, size.x * size.y);
  EXPECT_EQ(a.wrong, 0) << "worst " << a.worst;
}

TEST_F(Direct, BothSidesReflectButLightStaysOnItsSide) {
  Scene scene;
  add_quad(scene, add_material(scene, glm::vec3(0.5f)), {-1, 0, -1}, {0, 0, 2}, {2, 0, 0});
  update_bounds(scene);
  const Camera below = look_at_camera({0, -2, 0.1f}, {0, 0, 0}, 0.5f, scene.bounds_min, scene.bounds_max);
  scene.lights = {sun_light({0, 1, 0}, 2.0f)};
  EXPECT_NEAR(render_direct(context(), scene, below, size).radiance.at(64, 64).r, 1.0 / glm::pi<double>(), 1e-4);
  scene.lights = {sun_light({0, -1, 0}, 2.0f)};
  EXPECT_EQ(render_direct(context(), scene, below, size).radiance.at(64, 64), glm::vec3(0.0f));
}

double rmse_percent(const Image& a, const Image& b, float b_factor) {
  double sum = 0.0;
  double mean = 0.0;
  for (size_t i = 0; i < a.pixels.size(); ++i) {
    const glm::dvec3 d = glm::dvec3(a.pixels[i]) - glm::dvec3(b.pixels[i]) * double(b_factor);
    sum += glm::dot(d, d);
    mean += glm::dot(glm::dvec3(a.pixels[i]), glm::dvec3(1.0));
  }
  const double n = 3.0 * double(a.pixels.size());
  return 100.0 * std::sqrt(sum / n) / (mean / n);
}

std::vector<Light> three_lights() {
  return {point_light({-0.9f, 2.0f, 1.3f}, 20.0f), sun_light({-0.6f, -1.0f, -0.4f}, 3.0f),
          spot_light({1.5f, 2.5f, 1.5f}, {-0.5f, -1, -0.5f}, 15, 35, 30)};
}

TEST_F(Direct, DoesNotDependOnTheScale) {
  Scene scene = stage();
  scene.lights = three_lights();
  const Camera camera = stage_camera(scene);
  const Image at_one = render_direct(context(), scene, camera, size).radiance;
  for (const float s : {1e-3f, 1e3f}) {
    Scene scaled = scene;
    for (Mesh& mesh : scaled.meshes) {
      for (glm::vec3& p : mesh.positions) p *= s;
    }
    update_bounds(scaled);
    for (Light& light : scaled.lights) {
      light.position *= s;
      if (light.type != Light::Type::directional) light.intensity *= s * s;
    }
    Camera scaled_camera = camera;
    scaled_camera.world_from_camera[3] = glm::vec4(s * glm::vec3(camera.world_from_camera[3]), 1.0f);
    scaled_camera.znear *= s;
    scaled_camera.zfar *= s;
    EXPECT_LT(rmse_percent(at_one, render_direct(context(), scaled, scaled_camera, size).radiance, 1.0f), 0.1) << s;
  }
}

TEST_F(Direct, ScalesWithTheIntensity) {
  Scene scene = stage();
  scene.lights = three_lights();
  const Image at_one = render_direct(context(), scene, stage_camera(scene), size).radiance;
  for (const float factor : {1e-6f, 1e9f}) {
    Scene bright = scene;
    for (Light& light : bright.lights) light.intensity *= factor;
    const Image image = render_direct(context(), bright, stage_camera(scene), size).radiance;
    EXPECT_LT(rmse_percent(at_one, image, 1.0f / factor), 1e-3) << factor;
  }
}

TEST_F(Direct, RepeatsExactly) {
  Scene scene = stage();
  scene.lights = three_lights();
  const Image a = render_direct(context(), scene, stage_camera(scene), size).radiance;
  EXPECT_EQ(a.pixels, render_direct(context(), scene, stage_camera(scene), size).radiance.pixels);
}

TEST_F(Direct, NoLightsAndNoTrianglesAreBlack) {
  Scene scene = stage();
  const Camera camera = stage_camera(scene);
  const Image black(size.x, size.y);
  EXPECT_EQ(render_direct(context(), scene, camera, size).radiance.pixels, black.pixels);
  scene.lights = three_lights();
  scene.meshes.clear();
  update_bounds(scene);
  EXPECT_EQ(render_direct(context(), scene, camera, size).radiance.pixels, black.pixels);
}

}  // namespace
}  // namespace volgi::test
