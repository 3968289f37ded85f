// Lights on emissive surfaces: the closed form of one that hides nothing, what hides it, and what coarse to fine saves.
#include "screen/gather/area/area_gather.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/constants.hpp>

#include "reference/metrics.h"
#include "reference/path_tracer.h"
#include "reference/virtual_light_tracer.h"
#include "screen/sources/textured_area/area_lights.h"
#include "screen/visibility/screen_voxels/screen_voxels.h"
#include "screen/visibility/visibility_choice.h"
#include "tests/screen/screen_scene.h"
#include "tests/support/frame_picture.h"
#include "tests/support/gl_test.h"

namespace volgi::test {
namespace {

using screen::LightPart;
using Ways = screen::VisibilityChoice::Ways;

constexpr glm::ivec2 SIZE(96, 96);

/// A floor of 2 m, a lamp of half a metre over it that faces down, and, where it is asked for, a plate between.
Scene under_a_lamp(bool with_plate) {
  Scene scene;
  const int lamp = add_material(scene, glm::vec3(0.0f)), grey = add_material(scene, glm::vec3(0.5f));
  scene.materials[size_t(lamp)].emissive_radiance = {10.0f, 6.0f, 2.0f};
  add_quad(scene, grey, {-1, 0, 1}, {2, 0, 0}, {0, 0, -2});
  add_quad(scene, lamp, {-0.25f, 1, -0.25f}, {0.5f, 0, 0}, {0, 0, 0.5f});
  if (with_plate) add_quad(scene, grey, {-0.2f, 0.5f, 0.2f}, {0.4f, 0, 0}, {0, 0, -0.4f});
  update_bounds(scene);
  return scene;
}

class AreaGather : public GlTest {
 protected:
  static Rendered seen(const Scene& scene, Ways ways, const screen::AreaGatherOptions& area = {}) {
    screen::FrameOptions o = picture_options("area", SIZE, LightPart::direct);
    o.of<screen::VisibilityChoice>().ways = ways;
    o.of<screen::AreaGatherOptions>() = area;
    return render(context(), scene, camera(scene), o);
  }
  static Camera camera(const Scene& scene) {
    return look_at_camera({0, 2.0f, 2.2f}, {0, 0.2f, 0}, 0.9f, scene.bounds_min, scene.bounds_max);
  }
};

double difference_percent(const Image& a, const Image& b) {
  double squares = 0.0, sum = 0.0;
  for (size_t i = 0; i < a.pixels.size(); ++i) {
    squares += double(glm::dot(a.pixels[i] - b.pixels[i], a.pixels[i] - b.pixels[i]));
    sum += double(b.pixels[i].x + b.pixels[i].y + b.pixels[i].z) / std::sqrt(3.0);
  }
  return 100.0 * std::sqrt(squares * double(a.pixels.size())) / sum;
}

// On the axis of a square of edge 2 a at distance d: E = 4 pi L F of a corner's quarter (Howell, B-3).
TEST_F(AreaGather, UnderASquareLamp) {
  const Scene scene = under_a_lamp(false);
  const double a = 0.25, s = std::sqrt(1.0 + a * a);
  const double quarter = 2.0 * a / s * std::atan(a / s) / (2.0 * glm::pi<double>());
  const double radiance = 0.5 / glm::pi<double>() * 10.0 * glm::pi<double>() * 4.0 * quarter;
  screen::FrameOptions o = picture_options("area", {32, 32}, LightPart::direct);
  const Camera down = look_at_camera({0, 0.9f, 0.001f}, {0, 0, 0}, 0.05f, scene.bounds_min, scene.bounds_max);
  const Image image = render(context(), scene, down, o).image;
  EXPECT_NEAR(double(image.at(16, 16).x), radiance, 0.01 * radiance);  // 256 disks for a square
}

// A plate hides the middle of the floor: from voxels and faces as from rays to the same lights.
TEST_F(AreaGather, WhatHidesALampAsRaysToItsLights) {
  const Scene scene = under_a_lamp(true);
  const Image open = seen(scene, Ways::none).image;
  screen::FrameOptions o = picture_options("area", SIZE, LightPart::direct);
  screen::Frame frame(scene, o);
  gl::PassTimer timer(context().software(), false);
  frame.render(camera(scene), timer);
  VirtualLightGatherOptions traced;
  traced.size = SIZE;
  const Image exact = gather_virtual_lights(scene, camera(scene), frame.virtual_lights(), traced).color;
  EXPECT_GT(difference_percent(open, exact), 20.0);  // there is something to hide
  const double voxels = difference_percent(seen(scene, Ways::voxels).image, exact);
  const double faces = difference_percent(seen(scene, Ways::faces).image, exact);
  RecordProperty("voxels", std::to_string(voxels));
  RecordProperty("faces", std::to_string(faces));
  EXPECT_LT(voxels, 8.0);
  EXPECT_LT(faces, 12.0);  // cells of 6 cm
  // Rays of the CPU are those rays, but at the disk's edge, where a way may pass either way.
  const Rendered rays = seen(scene, Ways::rays, {.coarsest = 1, .interleave = 0});
  EXPECT_LT(difference_percent(rays.image, exact), 0.2);
  const Rendered few = seen(scene, Ways::rays, {.coarsest = 8, .interleave = 0});
  RecordProperty("rays", std::to_string(difference_percent(rays.image, exact)));
  RecordProperty("rays_coarse_to_fine", std::to_string(difference_percent(few.image, exact)));
  EXPECT_LT(difference_percent(few.image, exact), 2.5);
  EXPECT_LT(few.report.number("ways_asked"), 0.3 * rays.report.number("ways_asked"));
}

TEST_F(AreaGather, CoarseToFineAsksForFewWays) {
  const Scene scene = under_a_lamp(true);
  // From 8 pixels on: the picture is small. 0.7 % on area_tv at 192 x 192, from 16.
  const Rendered all = seen(scene, Ways::voxels, {.coarsest = 8, .incremental = false, .interleave = 0});
  const Rendered few = seen(scene, Ways::voxels, {.coarsest = 8, .interleave = 0});
  EXPECT_LT(difference_percent(few.image, all.image), 1.0);
  EXPECT_LT(few.report.number("ways_asked"), 0.6 * all.report.number("ways_asked"));
  const Rendered every = seen(scene, Ways::voxels, {.coarsest = 1, .interleave = 0});
  EXPECT_LT(few.report.number("gathered_share"), 0.8 * every.report.number("gathered_share"));
  EXPECT_LT(difference_percent(few.image, every.image), 4.0);  // and what is interpolated
  EXPECT_LT(few.report.number("ways_asked"), 0.4 * every.report.number("ways_asked"));
}

// 256 lights say what 1024 do; groups of 16 in several dispatches, of which each thread would have more turns of loops
// than llvmpipe grants in one: it then sees nothing.
TEST_F(AreaGather, MoreLightsThanBits) {
  const Scene scene = under_a_lamp(true);
  const Image few = seen(scene, Ways::voxels).image;
  screen::FrameOptions o = picture_options("area", SIZE, LightPart::direct);
  o.of<screen::VisibilityChoice>().ways = Ways::voxels;
  o.of<screen::AreaLightOptions>().lights = 1024;
  const Image many = render(context(), scene, camera(scene), o).image;
  EXPECT_LT(difference_percent(many, few), 5.0);  // 64 ways a pixel on coarse levels are not 256
  // Ways cross fewer than 512 texels of 256: twice as many samples at most are the same ones, in other dispatches.
  o.of<screen::AreaLightOptions>().lights = 256;
  o.of<screen::ScreenVoxelOptions>() = {.texels = 256, .steps = 512};
  const Image at_once = render(context(), scene, camera(scene), o).image;
  o.of<screen::ScreenVoxelOptions>().steps = 1024;
  EXPECT_LT(difference_percent(render(context(), scene, camera(scene), o).image, at_once), 0.01);
}

// Shared out to 2 x 2 pixels: near to all lights at all of them, for a quarter of the ways. Shadows are a pixel softer,
// of which the plate's edges have most: 3.5 %, and both err by 4 to 5 % against rays.
TEST_F(AreaGather, PixelsShareLights) {
  const Scene scene = under_a_lamp(true);
  const Rendered own = seen(scene, Ways::voxels, {.coarsest = 1, .interleave = 0});
  const Rendered shared = seen(scene, Ways::voxels, {.coarsest = 1, .interleave = 1});
  EXPECT_LT(difference_percent(shared.image, own.image), 5.0);
  EXPECT_LT(shared.report.number("ways_asked"), 0.26 * own.report.number("ways_asked"));
}

/// A dark room's corner with a lamp low on the wall, over a floor of metal that shines as Phong has it.
Scene metal_floor(float exponent) {
  Scene scene;
  const int wall = add_material(scene, glm::vec3(0.0f)), floor = add_material(scene, glm::vec3(0.9f));
  const int lamp = add_material(scene, glm::vec3(0.0f));
  scene.materials[size_t(floor)].metallic_factor = 1.0f;
  for (Material& m : scene.materials) m.phong = true;
  scene.materials[size_t(floor)].roughness_factor = std::pow(2.0f * exponent + 1.0f, -0.25f);
  scene.materials[size_t(lamp)].emissive_radiance = {10.0f, 6.0f, 2.0f};
  add_quad(scene, floor, {-1, 0, 1}, {2, 0, 0}, {0, 0, -2});
  add_quad(scene, wall, {-1, 0, -1}, {2, 0, 0}, {0, 2, 0});
  add_quad(scene, wall, {-0.5f, 0, -0.5f}, {0.4f, 0, 0}, {0, 0.5f, 0});  // hides a part
  add_quad(scene, lamp, {-0.3f, 0.2f, -0.97f}, {0.8f, 0, 0}, {0, 0.6f, 0});
  update_bounds(scene);
  return scene;
}

// By lights where nine or more lie in the lobe, else by samples of the lamp's picture.
TEST_F(AreaGather, PhongFloorsBesideALampAsTraced) {
  for (const float exponent : {20.0f, 80.0f}) {
    const Scene scene = metal_floor(exponent);
    const Camera from = look_at_camera({0.3f, 0.8f, 1.2f}, {0, 0.1f, -0.4f}, 1.0f, scene.bounds_min, scene.bounds_max);
    PathTracerOptions traced;
    traced.size = {64, 64};
    traced.samples_per_pixel = 256;
    traced.light = PathTracerOptions::Light::direct;
    const ReferencePicture reference = path_trace(scene, from, traced);
    const RegionLayers layers{reference.position, reference.normal, reference.direct, reference.id, reference.depth};
    screen::FrameOptions o = picture_options("area", traced.size, LightPart::direct);
    o.of<screen::VisibilityChoice>().ways = Ways::faces;
    const Rendered ours = render(context(), scene, from, o);
    const Metrics m = measure(reference.color, ours.image, nullptr, region_mask(Region::noedge, layers));
    RecordProperty("rmse_percent_" + std::to_string(int(exponent)), std::to_string(m.relative.value().rmse_pct));
    EXPECT_LT(m.relative->rmse_pct, 12.0) << exponent;
    EXPECT_NEAR(m.relative->ratio, 1.0, 0.05) << exponent;
    EXPECT_GT(ours.report.number("narrow_lobe_share"), 0.02) << exponent;
  }
}

}  // namespace
}  // namespace volgi::test
