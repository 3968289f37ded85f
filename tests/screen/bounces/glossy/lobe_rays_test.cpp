// What mirrors of facets reflect: in a furnace, beside a light against the path tracer, and who gets rays at all.
#include "screen/bounces/glossy/lobe_rays.h"

#include <gtest/gtest.h>

#include <string>

#include "core/gl/objects.h"
#include "propagation/volume_options.h"
#include "reference/metrics.h"
#include "reference/path_tracer.h"
#include "tests/screen/screen_scene.h"
#include "tests/support/frame_picture.h"
#include "tests/support/gl_test.h"

namespace volgi::test {
namespace {

using screen::LightPart;

constexpr glm::ivec2 SIZE(64, 64);

/// A closed box of 2 m, seen from inside, with a metal floor.
Scene box(glm::vec3 emitted, float roughness) {
  Scene scene;
  const int wall = add_material(scene, glm::vec3(0.0f)), floor = add_material(scene, glm::vec3(0.9f));
  scene.materials[size_t(wall)].emissive_radiance = emitted;
  scene.materials[size_t(floor)].metallic_factor = 1.0f;
  scene.materials[size_t(floor)].roughness_factor = roughness;
  add_quad(scene, floor, {-1, 0, 1}, {2, 0, 0}, {0, 0, -2});
  add_quad(scene, wall, {-1, 2, -1}, {2, 0, 0}, {0, 0, 2});
  add_quad(scene, wall, {-1, 0, -1}, {2, 0, 0}, {0, 2, 0});
  add_quad(scene, wall, {1, 0, 1}, {-2, 0, 0}, {0, 2, 0});
  add_quad(scene, wall, {-1, 0, 1}, {0, 0, -2}, {0, 2, 0});
  add_quad(scene, wall, {1, 0, -1}, {0, 0, 2}, {0, 2, 0});
  update_bounds(scene);
  return scene;
}

Camera inside(const Scene& scene) {
  return look_at_camera({0, 1.2f, 0.9f}, {0, 0.2f, -0.4f}, 1.0f, scene.bounds_min, scene.bounds_max);
}

class LobeRays : public GlTest {
 protected:
  static screen::FrameOptions options(int rays, LightPart light = LightPart::full) {
    screen::FrameOptions o = picture_options("hybrid", SIZE, light);
    o.of<VolumeOptions>().grid_cells = 24;
    o.of<screen::GlossyOptions>() = {.rays = rays, .interleave = 2};  // small pictures have small blocks
    return o;
  }
  /// With the CPU's volume: in software the GPU's takes seconds, and these passes are the same.
  static Rendered seen(const Scene& scene, screen::FrameOptions o) {
    o.backend = screen::Backend::cpu;
    screen::Frame frame(scene, o);
    gl::PassTimer timer(context().software(), false);
    frame.render(inside(scene), timer);
    return {screen::image_from_texture(frame.radiance()), frame.report()};
  }
  static void expect_as_traced(const Scene& scene, LightPart light, double limit_percent) {
    PathTracerOptions traced;
    traced.size = SIZE;
    traced.samples_per_pixel = 96;
    if (light == LightPart::direct) traced.light = PathTracerOptions::Light::direct;
    const ReferencePicture reference = path_trace(scene, inside(scene), traced);
    const RegionLayers layers{reference.position, reference.normal, reference.direct, reference.id, reference.depth};
    const Metrics m =
        measure(reference.color, seen(scene, options(16, light)).image, nullptr, region_mask(Region::noedge, layers));
    RecordProperty("rmse_percent", std::to_string(m.relative->rmse_pct));
    EXPECT_LT(m.relative->rmse_pct, limit_percent);
    EXPECT_NEAR(m.relative->ratio, 1.0, 0.05);
  }
};

// Where the same light comes from everywhere, a lobe reflects its directional albedo, found by rays, by lights, and by
// the two together: what they count as must sum to one. The floor's own light, 0.9 of it, is even as well but in its
// corners.
TEST_F(LobeRays, AFurnaceLooksTheSameByRays) {
  for (const float roughness : {0.3f, 0.6f}) {
    const Scene scene = box(glm::vec3(1.0f), roughness);
    const Image even = seen(scene, options(0, LightPart::direct)).image;
    const Rendered by_rays = seen(scene, options(8, LightPart::direct));
    EXPECT_GT(by_rays.report.number("glossy_share"), 0.2);
    EXPECT_EQ(by_rays.report.number("glossy_widened_share"), 0.0);
    // Of the floor the upper half of the sphere is seen: all of what the walls send, but what goes down past the
    // horizon.
    double sum_even = 0.0, sum_rays = 0.0, squares = 0.0;
    int count = 0;
    for (int y = 0; y < SIZE.y / 3; ++y) {
      for (int x = SIZE.x / 4; x < 3 * SIZE.x / 4; ++x) {
        const double a = even.at(x, SIZE.y - 1 - y).x, b = by_rays.image.at(x, SIZE.y - 1 - y).x;
        sum_even += a;
        sum_rays += b;
        squares += (b - a) * (b - a);
        ++count;
      }
    }
    EXPECT_NEAR(sum_rays / sum_even, 1.0, 0.03) << roughness;
    EXPECT_LT(std::sqrt(squares / count) / (sum_even / count), 0.06) << roughness;
  }
}

/// The same box, dark, with a lamp low on its wall.
Scene beside_a_lamp(float roughness) {
  Scene scene = box(glm::vec3(0.0f), roughness);
  const int lamp = add_material(scene, glm::vec3(0.0f)), wall = add_material(scene, glm::vec3(0.6f));
  scene.materials[size_t(lamp)].emissive_radiance = {10.0f, 6.0f, 2.0f};
  for (size_t m = 1; m < scene.meshes.size(); ++m) scene.meshes[m].material = wall;
  add_quad(scene, lamp, {-0.3f, 0.2f, -0.97f}, {0.5f, 0, 0}, {0, 0.4f, 0});
  update_bounds(scene);
  return scene;
}

TEST_F(LobeRays, AFloorBesideALampAsTraced) {
  expect_as_traced(beside_a_lamp(0.4f), LightPart::direct, 12.0);
  expect_as_traced(beside_a_lamp(0.4f), LightPart::full, 12.0);
}

// Phong lobes of exponents 20 and 80, which are roughness 0.395 and 0.281: neither is widened.
TEST_F(LobeRays, APhongFloorBesideALampAsTraced) {
  for (const float exponent : {20.0f, 80.0f}) {
    Scene scene = beside_a_lamp(std::pow(2.0f * exponent + 1.0f, -0.25f));
    for (Material& m : scene.materials) m.phong = true;
    EXPECT_EQ(seen(scene, options(2)).report.number("glossy_widened_share"), 0.0) << exponent;
    expect_as_traced(scene, LightPart::direct, 12.0);
    if (exponent == 20.0f) expect_as_traced(scene, LightPart::full, 12.0);
  }
}

TEST_F(LobeRays, WhatIsNarrowerIsWidenedAndSaidSo) {
  const Rendered r = seen(beside_a_lamp(0.05f), options(2));
  EXPECT_EQ(r.report.number("glossy_widened_share"), 1.0);
}

TEST_F(LobeRays, ASteadyFrameMakesNoObjects) {
  const Scene scene = beside_a_lamp(0.4f);
  screen::FrameOptions o = options(2);
  o.backend = screen::Backend::cpu;
  screen::Frame frame(scene, o);
  gl::PassTimer timer(context().software(), false);
  for (int k = 0; k < 2; ++k) frame.render(inside(scene), timer);
  const std::uint64_t before = gl::objects_made();
  frame.render(inside(scene), timer);
  EXPECT_EQ(gl::objects_made(), before);
}

/// Mean of a band over the pixels of a plate in a picture's lower middle.
double of_the_plate(const Image& image) {
  double sum = 0.0;
  int count = 0;
  for (int y = 41; y < 54; ++y) {
    for (int x = 29; x < 35; ++x, ++count) sum += double(image.at(x, y).y);
  }
  return sum / count;
}

// Each bounce more adds what the path tracer's adds: of a lamp that rays find, and of a spot whose first reflection is
// by virtual lights and whose second is by the sides that these light. Only a small plate shines: what metal sends on
// counts as diffuse.
TEST_F(LobeRays, ACountOfBouncesHasTheseOrders) {
  Scene scene = beside_a_lamp(0.4f);
  const int metal = scene.meshes[0].material, grey = add_material(scene, glm::vec3(0.6f));
  scene.meshes[0].material = grey;
  add_quad(scene, metal, {-0.1f, 0.005f, 0.2f}, {0.2f, 0, 0}, {0, 0, -0.5f});
  scene.lights.push_back(spot_light({0.5f, 1.8f, 0.5f}, {-1.0f, -0.3f, -1.0f}, 20.0f, 35.0f, 20.0f));
  const auto bounced = [&](std::optional<int> bounces) {
    screen::FrameOptions o = options(8, LightPart::indirect);
    o.bounces = bounces;
    return of_the_plate(seen(scene, o).image);
  };
  const auto traced = [&](std::optional<int> bounces) {
    PathTracerOptions o;
    o.size = SIZE;
    o.samples_per_pixel = 48;
    o.max_bounces = bounces;
    o.light = PathTracerOptions::Light::indirect;
    return of_the_plate(path_trace(scene, inside(scene), o).color);
  };
  double before = 0.0, traced_before = 0.0;
  for (int n = 1; n <= 3; ++n) {
    const double now = bounced(n), traced_now = traced(n);
    EXPECT_NEAR((now - before) / (traced_now - traced_before), 1.0, 0.15) << n;
    before = now;
    traced_before = traced_now;
  }
  EXPECT_NEAR(bounced(30) / bounced(std::nullopt), 1.0, 0.005);
}

TEST_F(LobeRays, WhatDoesNotShineIsLeftAlone) {
  Scene scene = beside_a_lamp(0.4f);
  for (Material& m : scene.materials) m.lambertian = true;
  const Image with = seen(scene, options(2)).image, without = seen(scene, options(0)).image;
  EXPECT_EQ(with.pixels, without.pixels);
}

}  // namespace
}  // namespace volgi::test
