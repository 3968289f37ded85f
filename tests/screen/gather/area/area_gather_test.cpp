// Lights on emissive surfaces: the closed form of one that hides nothing, what hides it, and what coarse to fine saves.
#include "screen/gather/area/area_gather.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/constants.hpp>

#include "core/error.h"
#include "reference/virtual_light_tracer.h"
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
}

TEST_F(AreaGather, CoarseToFineAsksForFewWays) {
  const Scene scene = under_a_lamp(true);
  // From 8 pixels on: the picture is small. 0.7 % on area_tv at 192 x 192, from 16.
  const Rendered all = seen(scene, Ways::voxels, {.coarsest = 8, .incremental = false});
  const Rendered few = seen(scene, Ways::voxels, {.coarsest = 8});
  EXPECT_LT(difference_percent(few.image, all.image), 1.0);
  EXPECT_LT(few.report.number("ways_asked"), 0.6 * all.report.number("ways_asked"));
  const Rendered every = seen(scene, Ways::voxels, {.coarsest = 1});
  EXPECT_LT(few.report.number("gathered_share"), 0.8 * every.report.number("gathered_share"));
  EXPECT_LT(difference_percent(few.image, every.image), 4.0);  // and what is interpolated
  EXPECT_LT(few.report.number("ways_asked"), 0.4 * every.report.number("ways_asked"));
}

TEST_F(AreaGather, RefusesMoreLightsThanBits) {
  screen::FrameOptions o = picture_options("area", SIZE);
  o.of<screen::AreaLightOptions>().lights = 257;
  EXPECT_THROW(screen::Frame(under_a_lamp(false), o), Error);
}

}  // namespace
}  // namespace volgi::test
