// Panes of coloured glass (docs/hard-cases.md, "glass"): light that passes has the glass's colour, and as much of it as
// passes. On both backends, and in the path tracer.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "core/sky.h"
#include "reference/path_tracer.h"
#include "tests/hardcases/frame_case.h"
#include "tests/support/frame_picture.h"
#include "tests/support/gl_test.h"
#include "tests/support/volume_scenes.h"

namespace volgi::test {
namespace {

using Glass = GlTest;

constexpr glm::vec3 COLOUR(0.8f, 0.4f, 0.1f);
constexpr glm::ivec2 SIZE(64);

int add_glass(Scene& scene, glm::vec3 colour, float passes) {
  const int glass = add_material(scene, colour);
  Material& m = scene.materials[size_t(glass)];
  m.base_color_factor.a = passes;
  m.alpha_mode = AlphaMode::glass;
  return glass;
}

void add_sheet(Scene& scene, int material, float y, float half) {
  add_quad(scene, material, {-half, y, half}, {2 * half, 0, 0}, {0, 0, -2 * half});
}

Light lamp_at(float y) {
  Light lamp;
  lamp.position = {0.2f, y, 0.1f};
  lamp.intensity = glm::vec3(3.0f);
  return lamp;
}

Light steep_sun() {
  Light sun;
  sun.type = Light::Type::directional;
  sun.direction = glm::normalize(glm::vec3(0.2f, -1.0f, 0.1f));
  sun.intensity = glm::vec3(2.0f);
  return sun;
}

/// A floor, and panes above it at the heights that are given.
Scene floor_below(std::initializer_list<float> panes, float passes, float half = 6.0f, float half_of_pane = 6.0f) {
  Scene scene;
  add_sheet(scene, add_material(scene, glm::vec3(0.5f)), 0.0f, half);
  const int glass = add_glass(scene, COLOUR, passes);
  for (const float y : panes) add_sheet(scene, glass, y, half_of_pane);
  return scene;
}

Camera from_above(Scene& scene, float eye_y) {
  update_bounds(scene);
  return look_at_camera({0.3f, eye_y, 0.4f}, {0.0f, 0.0f, 0.0f}, 0.7f, scene.bounds_min, scene.bounds_max);
}

glm::dvec3 mean(const Image& image) {
  glm::dvec3 sum(0.0);
  for (const glm::vec3& p : image.pixels) sum += glm::dvec3(p);
  return sum / double(image.pixels.size());
}

Image traced(const Scene& scene, const Camera& camera, PathTracerOptions::Light light, int samples) {
  PathTracerOptions o;
  o.size = SIZE;
  o.light = light;
  o.samples_per_pixel = samples;
  return path_trace(scene, camera, o).color;
}

Image direct_of(const gl::Context& context, const Scene& scene, const Camera& camera) {
  return render(context, scene, camera, picture_options("none", SIZE, screen::LightPart::direct)).image;
}

void expect_ratio(const Image& with, const Image& without, glm::dvec3 expected, double tolerance, const char* what) {
  const glm::dvec3 a = mean(with), b = mean(without);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c] / b[c], expected[c], tolerance * expected[c]) << what << ' ' << c;
}

/// @param panes  between the lamps and the floor; the camera is at eye_y.
void expect_direct_light(const gl::Context& context, std::initializer_list<float> panes, float passes, float lamp_y,
                         float eye_y, glm::dvec3 expected, double of_rays, double of_maps) {
  for (const Light& light : {lamp_at(lamp_y), steep_sun()}) {
    if (light.type == Light::Type::directional && lamp_y < 1.0f) continue;  // a sun is above everything
    Scene with = floor_below(panes, passes), without = floor_below({}, passes);
    with.lights = without.lights = {light};
    const Camera camera = from_above(with, eye_y);
    from_above(without, eye_y);
    const auto direct = PathTracerOptions::Light::direct;
    expect_ratio(traced(with, camera, direct, passes < 1.0f ? 64 : 4), traced(without, camera, direct, 1), expected,
                 of_rays, "path tracer");
    expect_ratio(direct_of(context, with, camera), direct_of(context, without, camera), expected, of_maps, "maps");
  }
}

// A lamp over a pane over a floor: E = share * colour * I cos / d^2. Glass that lets all of its colour pass decides
// nothing by chance. What is left are colours of 16 bits, and the albedo's.
TEST_F(Glass, ColoursTheLightOfLamps) {
  const glm::dvec3 once(COLOUR);
  expect_direct_light(context(), {1.0f}, 1.0f, 2.0f, 0.8f, once, 1e-5, 1e-3);
  expect_direct_light(context(), {1.0f, 1.2f}, 1.0f, 2.0f, 0.8f, once * once, 1e-5, 1e-3);
}

// By chance: 64² pixels, or texels, of a share of 0.6 have a standard error of sqrt(0.4/0.6)/64 = 1.3 %; a lamp's
// texels are not all seen. Four of them.
TEST_F(Glass, LetsItsShareOfTheLightPass) {
  expect_direct_light(context(), {1.0f}, 0.6f, 2.0f, 0.8f, 0.6 * glm::dvec3(COLOUR), 0.01, 0.052);
}

// The camera looks through the pane at a floor that a lamp below it lights; with the lamp above, light passes twice.
TEST_F(Glass, ColoursWhatIsSeenThroughIt) {
  const glm::dvec3 once(COLOUR);
  expect_direct_light(context(), {1.0f}, 1.0f, 0.6f, 2.5f, once, 1e-5, 1e-3);
  expect_direct_light(context(), {1.0f}, 1.0f, 2.0f, 2.5f, once * once, 1e-5, 1e-3);
}

// Under a pane that reaches far beyond what is seen, even light of a sky is coloured as any other. Between the rim of
// the pane, 60 m away and 0.8 m high, and the horizon 1.8e-4 of it come in, of blue 0.2 % of what is left.
TEST_F(Glass, ColoursTheSky) {
  Scene with = floor_below({0.8f}, 1.0f, 6.0f, 60.0f), without = floor_below({}, 1.0f);
  with.sky = without.sky = std::make_shared<Sky>(glm::vec3(1.0f));
  const Camera camera = from_above(with, 0.6f);
  from_above(without, 0.6f);
  const auto direct = PathTracerOptions::Light::direct;
  const glm::dvec3 expected(COLOUR);
  expect_ratio(traced(with, camera, direct, 64), traced(without, camera, direct, 64), expected, 0.005, "path tracer");
  const auto picture = [&](const Scene& scene) {
    return render(context(), scene, camera, picture_options("hybrid", SIZE, screen::LightPart::direct)).image;
  };
  expect_ratio(picture(with), picture(without), expected, 0.03, "maps");
}

// The sun through a coloured pane in the roof of a white room: what its walls reflect has the colour, in each recipe
// that carries all bounces. Against the path tracer; without colour in the glass the blue would be 4 times too bright.
TEST_F(Glass, ColoursIndirectLight) {
  Scene scene;
  const int wall = add_material(scene, glm::vec3(0.6f)), glass = add_glass(scene, COLOUR, 1.0f);
  const auto quad = [&](int m, glm::vec3 corner, glm::vec3 u, glm::vec3 v) { add_quad(scene, m, corner, u, v); };
  quad(wall, {-1, -1, 1}, {2, 0, 0}, {0, 0, -2});
  quad(wall, {-1, -1, -1}, {2, 0, 0}, {0, 2, 0});
  quad(wall, {1, -1, 1}, {-2, 0, 0}, {0, 2, 0});
  quad(wall, {-1, -1, 1}, {0, 0, -2}, {0, 2, 0});
  quad(wall, {1, -1, -1}, {0, 0, 2}, {0, 2, 0});
  quad(wall, {-1, 1, -1}, {0.6f, 0, 0}, {0, 0, 2});
  quad(wall, {0.4f, 1, -1}, {0.6f, 0, 0}, {0, 0, 2});
  quad(wall, {-0.4f, 1, -1}, {0.8f, 0, 0}, {0, 0, 0.6f});
  quad(wall, {-0.4f, 1, 0.4f}, {0.8f, 0, 0}, {0, 0, 0.6f});
  quad(glass, {-0.4f, 1, -0.4f}, {0.8f, 0, 0}, {0, 0, 0.8f});
  scene.lights = {steep_sun()};
  update_bounds(scene);
  const Camera camera =
      look_at_camera({0.1f, -0.2f, 0.95f}, {-0.1f, -0.1f, -1.0f}, 1.1f, scene.bounds_min, scene.bounds_max);
  const Image truth = traced(scene, camera, PathTracerOptions::Light::indirect, 64);
  for (const Gi gi : {Gi("hybrid"), Gi("volume")}) {
    const Image image = render(context(), scene, camera, picture_options(gi, SIZE, screen::LightPart::indirect)).image;
    const glm::dvec3 ratio = mean(image) / mean(truth);
    for (int c = 0; c < 3; ++c)
      expect_of_frame("glass", fmt::format("{}, indirect light under a coloured pane, {}", gi, "RGB"[c]),
                      off_percent(ratio[c]), 6.0);
  }
}

}  // namespace
}  // namespace volgi::test
