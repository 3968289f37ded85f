// Beside what is brightly lit and nearer than cells are large, pixels have the light that paths find.
#include "screen/bounces/volume/contacts.h"

#include <gtest/gtest.h>

#include <cmath>

#include "reference/path_tracer.h"
#include "tests/support/frame_picture.h"
#include "tests/support/gl_test.h"
#include "tests/support/volume_scenes.h"

namespace volgi::test {
namespace {

constexpr glm::ivec2 SIZE(48, 48);

Light spot(glm::vec3 position, glm::vec3 direction, float outer_deg, float intensity) {
  Light light;
  light.type = Light::Type::spot;
  light.position = position;
  light.direction = glm::normalize(direction);
  light.intensity = glm::vec3(intensity);
  light.inner_cone_rad = glm::radians(0.7f * outer_deg);
  light.outer_cone_rad = glm::radians(outer_deg);
  return light;
}

/// A room of 2 m with a lamp that glows upwards, 3 cm below the ceiling.
Scene room_with_slot() {
  Scene scene;
  const int walls = add_material(scene, glm::vec3(0.7f)), lamp = add_material(scene, glm::vec3(0.6f), glm::vec3(12.0f));
  add_box_inside(scene, walls, glm::vec3(0.0f, 1.0f, 0.0f), glm::vec3(1.0f));
  add_box(scene, lamp, glm::vec3(0.0f, 1.955f, 0.0f), glm::vec3(0.2f, 0.015f, 0.2f));
  update_bounds(scene);
  return scene;
}

/// A room with a step that a spot lights at its foot: its first bounce is near, too.
Scene room_with_lit_step() {
  Scene scene;
  const int walls = add_material(scene, glm::vec3(0.7f));
  add_box_inside(scene, walls, glm::vec3(0.0f, 1.0f, 0.0f), glm::vec3(1.0f));
  add_box(scene, walls, glm::vec3(0.5f, 0.1f, 0.0f), glm::vec3(0.5f, 0.1f, 1.0f));
  scene.lights = {spot({-0.9f, 1.9f, 0.0f}, {0.89f, -1.9f, 0.0f}, 3.0f, 800.0f)};
  update_bounds(scene);
  return scene;
}

class ContactsGl : public GlTest {
 protected:
  static Rendered picture(const Scene& scene, const Camera& camera, int cells, int paths) {
    screen::FrameOptions o = picture_options("hybrid", SIZE, screen::LightPart::indirect);
    o.backend = screen::Backend::cpu;
    o.of<VolumeOptions>().grid_cells = cells;
    o.of<VolumeOptions>().gather_rays = 64;
    o.of<screen::ContactOptions>().paths = paths;
    screen::Frame frame(scene, o);
    gl::PassTimer timer(context().software(), false);
    frame.render(camera, timer);
    return {screen::image_from_texture(frame.radiance()), frame.report()};
  }
  /// Root mean square of what pixels err by, without the reference's noise, of the mean.
  static double error(const Image& test, const ReferencePicture& right) {
    double products = 0.0, sum = 0.0;
    for (size_t i = 0; i < test.pixels.size(); ++i) {
      products += double(glm::dot(test.pixels[i] - right.half_a.pixels[i], test.pixels[i] - right.half_b.pixels[i]));
      sum += double(glm::dot(right.color.pixels[i], glm::vec3(1.0f)));
    }
    return std::sqrt(std::max(products, 0.0) * 3.0 * double(test.pixels.size())) / sum;
  }
  struct Errors {
    double without, with;
    size_t pixels;
  };
  static Errors errors(const Scene& scene, const Camera& camera, int cells) {
    PathTracerOptions o;
    o.size = SIZE;
    o.samples_per_pixel = 256;
    o.light = PathTracerOptions::Light::indirect;
    const ReferencePicture right = path_trace(scene, camera, o);
    const Rendered with = picture(scene, camera, cells, screen::ContactOptions().paths);
    const Errors e{error(picture(scene, camera, cells, 0).image, right), error(with.image, right),
                   with.report.of<screen::VolumeReport>().contact_pixels};
    RecordProperty("error", std::to_string(100.0 * e.without) + " -> " + std::to_string(100.0 * e.with));
    RecordProperty("pixels", int(e.pixels));
    return e;
  }
};

TEST_F(ContactsGl, ASlotOverALampIsAsBrightAsItIs) {
  const Scene scene = room_with_slot();
  const Errors e = errors(
      scene, look_at_camera({0.7f, 1.6f, 0.6f}, {0.1f, 1.97f, 0.1f}, 0.7f, scene.bounds_min, scene.bounds_max), 40);
  EXPECT_GT(e.pixels, 50u);
  EXPECT_LT(e.with, 0.5 * e.without);  // 50 % -> 17; in 24 cells no side shows what is in the slot, and nothing helps
}

TEST_F(ContactsGl, TheFootOfALitStepIsAsBrightAsItIs) {
  const Scene scene = room_with_lit_step();
  const Errors e = errors(
      scene, look_at_camera({-0.6f, 0.5f, 0.4f}, {0.0f, 0.05f, 0.0f}, 0.7f, scene.bounds_min, scene.bounds_max), 24);
  EXPECT_GT(e.pixels, 50u);
  EXPECT_LT(e.with, 0.5 * e.without);  // 55 % -> 19
}

// Where nothing is as bright, the picture is not touched.
TEST_F(ContactsGl, AnEvenlyLitRoomHasNone) {
  Scene scene;
  add_box_inside(scene, add_material(scene, glm::vec3(0.7f)), glm::vec3(0.0f, 1.0f, 0.0f), glm::vec3(1.0f));
  scene.lights = {spot({0.0f, 1.9f, 0.0f}, {0.0f, -1.0f, 0.0f}, 30.0f, 10.0f)};
  const Camera camera =
      look_at_camera({0.7f, 1.0f, 0.7f}, {-0.5f, 0.8f, -0.5f}, 1.2f, scene.bounds_min, scene.bounds_max);
  const Rendered with = picture(scene, camera, 24, screen::ContactOptions().paths),
                 without = picture(scene, camera, 24, 0);
  EXPECT_EQ(with.report.of<screen::VolumeReport>().contact_pixels, 0u);
  EXPECT_EQ(with.image.pixels, without.image.pixels);
}

}  // namespace
}  // namespace volgi::test
