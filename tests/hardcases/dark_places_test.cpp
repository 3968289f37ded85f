// What no light reaches stays dark in every pixel, not only in the mean (docs/hard-cases.md, "dark"): inside a closed
// box of sheets in a bright room (darkbox), inside a closed hall of sheets on sunlit ground (sunhall), upright, turned,
// moved off the cells, and with the whole scene turned.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "tests/hardcases/frame_case.h"
#include "tests/support/frame_picture.h"
#include "tests/support/gl_test.h"
#include "tests/support/invariance.h"
#include "tests/support/turned.h"
#include "tests/support/volume_scenes.h"

namespace volgi::test {
namespace {

constexpr glm::ivec2 kSize{96, 96};

struct Case {
  const char* name;
  glm::mat3 of_box;    // turns the box alone
  glm::vec3 moved;     // of the box [m]
  glm::mat3 of_scene;  // turns all
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

const glm::mat3 kStill(1.0f);
const glm::mat3 kTilt = rotation({0, 1, 0}, 17.0f) * rotation({1, 0, 0}, 8.0f);

void look(Scene& scene, glm::vec3 eye, glm::vec3 target, float yfov_rad) {
  scene.cameras = {look_at_camera(eye, target, yfov_rad, scene.bounds_min, scene.bounds_max)};
}

/// A camera in a box of 1.4 m that hangs in a room of 6 x 3 x 6 m with two lamps. Outside, 1 W/sr/m^2 and more.
Scene darkbox(const Case& c, bool inside = true) {
  Scene scene;
  const int white = add_material(scene, glm::vec3(0.8f));
  add_box_inside(scene, white, {0.0f, 1.5f, 0.0f}, {3.0f, 1.5f, 3.0f});
  const glm::vec3 middle = glm::vec3(0.0f, 1.2f, 0.0f) + c.moved;
  add_box_inside(scene, white, middle, glm::vec3(0.7f), c.of_box);
  for (glm::vec3 at : {glm::vec3(1.8f, 2.5f, 1.8f), glm::vec3(-1.8f, 0.3f, -1.8f)}) {
    Light lamp;
    lamp.type = Light::Type::point;
    lamp.position = at;
    lamp.intensity = glm::vec3(100.0f);
    scene.lights.push_back(lamp);
  }
  const glm::vec3 eye = inside ? middle + glm::vec3(0.3f, 0.1f, 0.3f) : glm::vec3(2.7f, 1.5f, 2.7f);
  look(scene, eye, middle - glm::vec3(0.4f, 0.3f, 0.4f), 1.5f);
  return turned(scene, c.of_scene);
}

/// A camera in a hall of 6 x 4 x 12 m on ground of 18 m in the sun.
Scene sunhall(const Case& c, bool inside = true) {
  Scene scene;
  const int white = add_material(scene, glm::vec3(0.8f));
  add_box_inside(scene, white, glm::vec3(0.0f, 2.0f, 0.0f) + c.moved, {3.0f, 2.0f, 6.0f}, c.of_box);
  add_quad(scene, white, {-9.0f, 0.0f, -9.0f}, {0.0f, 0.0f, 18.0f}, {18.0f, 0.0f, 0.0f});
  Light sun;
  sun.type = Light::Type::directional;
  sun.direction = glm::normalize(glm::vec3(-0.6f, -0.7f, 0.4f));
  sun.intensity = glm::vec3(10.0f);
  scene.lights.push_back(sun);
  if (inside) {
    look(scene, c.of_box * glm::vec3(2.4f, 1.6f, 5.4f), c.of_box * glm::vec3(0.6f, 1.4f, 0.0f), 1.13f);
  } else {
    look(scene, {0.0f, 8.0f, 12.0f}, {0.0f, 0.0f, 0.0f}, 1.0f);
  }
  return turned(scene, c.of_scene);
}

/// A closed room of 4 x 2.6 x 4 m with a box in it, as it is or on a ground plane of 200 m that lies 2 cm below.
Scene room(bool on_plane) {
  Scene scene;
  const int white = add_material(scene, glm::vec3(0.7f));
  add_box_inside(scene, white, {0.0f, 1.3f, 0.0f}, {2.0f, 1.3f, 2.0f});
  add_box_inside(scene, add_material(scene, {0.7f, 0.2f, 0.1f}), {-0.8f, 0.5f, -0.8f}, {0.4f, 0.5f, 0.4f});
  Light lamp;
  lamp.type = Light::Type::point;
  lamp.position = {0.9f, 2.2f, 0.6f};
  lamp.intensity = glm::vec3(6.0f);
  scene.lights = {lamp};
  look(scene, {1.8f, 1.5f, 1.9f}, {-0.5f, 1.0f, -1.0f}, 1.1f);
  if (on_plane) add_quad(scene, white, {-100.0f, -0.02f, -100.0f}, {0.0f, 0.0f, 200.0f}, {200.0f, 0.0f, 0.0f});
  return scene;
}

// What is outside of the box that the grid lies around changes nothing.
class GridInABox : public GlTest {};

TEST_F(GridInABox, ShowsTheRoomAsWithoutThePlane) {
  for (Gi gi : {Gi("volume"), Gi("hybrid")}) {
    screen::FrameOptions o = picture_options(gi, {64, 64}, screen::LightPart::indirect);
    o.of<VolumeOptions>().grid_cells = 24;
    const Scene alone = room(false), on_plane = room(true);
    const Image expected = render(context(), alone, alone.cameras.at(0), o).image;
    o.of<VolumeOptions>().grid_box = GridBox{alone.bounds_min, alone.bounds_max};
    const Image seen = render(context(), on_plane, alone.cameras.at(0), o).image;
    expect_of_frame("plane", fmt::format("{}, a closed room on a plane of 200 m, by --bounds", gi),
                    rmse_percent(seen, expected), 2.0);
  }
}

class DarkPlaces : public GlTest, public testing::WithParamInterface<Case> {
 protected:
  using MakeScene = Scene (*)(const Case&, bool inside);

  static Image picture(const Scene& scene, Gi gi, screen::LightPart light, int cells) {
    screen::FrameOptions o = picture_options(gi, kSize, light);
    o.of<VolumeOptions>().grid_cells = cells;
    return render(context(), scene, scene.cameras.at(0), o).image;
  }
  /// In the mean and in any pixel, as parts of the mean of all light on the lit side.
  static void expect_dark(MakeScene make, Gi gi, screen::LightPart light, int cells, const std::string& what) {
    const double lit = mean_light(picture(make(GetParam(), false), gi, screen::LightPart::full, cells));
    const Image dark = picture(make(GetParam(), true), gi, light, cells);
    double most = 0.0;
    int over = 0;
    for (const glm::vec3& p : dark.pixels) {
      const double share = double(p.x + p.y + p.z) / (3.0 * lit);
      most = std::max(most, share);
      over += int(share > 0.02);
    }
    ASSERT_GT(lit, 0.1) << what;
    EXPECT_EQ(over, 0) << what;
    expect_of_frame("dark", fmt::format("{}, {}, mean", what, GetParam().name), 100.0 * mean_light(dark) / lit, 0.5);
    expect_of_frame("dark", fmt::format("{}, {}, brightest pixel", what, GetParam().name), 100.0 * most, 2.0);
  }
};

TEST_P(DarkPlaces, Direct) {
  expect_dark(darkbox, "none", screen::LightPart::direct, 16, "darkbox_direct");
  expect_dark(sunhall, "none", screen::LightPart::direct, 16, "sunhall_direct");
}

TEST_P(DarkPlaces, Volume) {
  for (int cells : {16, 24, 64}) {
    if (cells == 64 && reason_to_skip(TestedOn::not_in_software, context()) != nullptr) continue;
    expect_dark(darkbox, "volume", screen::LightPart::indirect, cells, "darkbox_volume_" + std::to_string(cells));
    expect_dark(sunhall, "volume", screen::LightPart::indirect, cells, "sunhall_volume_" + std::to_string(cells));
  }
}

INSTANTIATE_TEST_SUITE_P(All, DarkPlaces,
                         testing::Values(Case{"Upright", kStill, {}, kStill},
                                         Case{"BoxTurned", rotation({0, 1, 0}, 30.0f), {}, kStill},
                                         Case{"OffTheCells", kStill, {0.03f, 0.0f, 0.05f}, kStill},
                                         Case{"AllTurned", kStill, {}, kTilt}),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace volgi::test
