// Surfaces that reflect all light (docs/hard-cases.md, "white").
#include <gtest/gtest.h>

#include "reference/metrics.h"
#include "reference/path_tracer.h"
#include "tests/hardcases/frame_case.h"
#include "tests/support/frame_picture.h"
#include "tests/support/gl_test.h"
#include "tests/support/volume_scenes.h"

namespace volgi::test {
namespace {

using White = GlTest;

/// A grey room and a lamp in a closed body that glows on both sides, inside too.
Scene lamp_in_its_body(float albedo_of_lamp) {
  Scene scene;
  add_box_inside(scene, add_material(scene, glm::vec3(0.7f)), glm::vec3(0.0f), glm::vec3(1.0f));
  const int glowing = add_material(scene, glm::vec3(albedo_of_lamp), glm::vec3(5.0f));
  scene.materials[size_t(glowing)].double_sided = true;
  add_box_inside(scene, glowing, {0.05f, 0.72f, -0.1f}, {0.32f, 0.11f, 0.27f});
  update_bounds(scene);
  return scene;
}

struct Shown {
  Metrics::Relative error;
  BounceReport bounces;
};

Shown shown(const gl::Context& context, const Scene& scene, Gi gi) {
  const Camera camera =
      look_at_camera({0.1f, -0.2f, 0.95f}, {-0.1f, -0.1f, -1.0f}, 1.1f, scene.bounds_min, scene.bounds_max);
  PathTracerOptions paths;
  paths.size = {64, 64};
  paths.samples_per_pixel = 64;
  paths.light = PathTracerOptions::Light::indirect;
  const ReferencePicture reference = path_trace(scene, camera, paths);
  const Rendered r = render(context, scene, camera, picture_options(gi, paths.size, screen::LightPart::indirect));
  return {measure(reference.color, r.image, nullptr,
                  region_mask(Region::noedge,
                              {reference.position, reference.normal, reference.direct, reference.id, reference.depth}))
              .relative.value(),
          r.report.of<screen::VolumeReport>().bounces};
}

// Nothing leaves the inside of a white body, which nobody sees: it must change nothing, neither the picture nor the
// number of orders.
TEST_F(White, TheInsideOfALampChangesNothing) {
  for (const float albedo : {0.9f, 1.0f}) {
    const Scene scene = lamp_in_its_body(albedo);
    for (const Gi gi : {Gi("hybrid"), Gi("volume")}) {
      const Shown s = shown(context(), scene, gi);
      const std::string key = std::string(gi) + (albedo < 1.0f ? "_grey" : "_white");
      expect_of_frame("white", fmt::format("{}, a closed lamp of albedo {}, energy", gi, albedo),
                      off_percent(s.error.ratio), 3.0);
      expect_of_frame("white", fmt::format("{}, a closed lamp of albedo {}, orders", gi, albedo), s.bounces.orders,
                      30.0, {}, {}, "orders");
      EXPECT_TRUE(s.bounces.converged) << key;
    }
  }
}

// No finite answer: it is given one, and named.
TEST_F(White, ASealedRoomIsNamed) {
  Scene scene;
  add_box_inside(scene, add_material(scene, glm::vec3(1.0f)), glm::vec3(0.0f), glm::vec3(1.0f));
  scene.lights = {point_light({0.2f, 0.3f, 0.1f}, glm::vec3(1.0f))};
  scene.name = "a sealed white room";
  update_bounds(scene);
  const Camera camera =
      look_at_camera({0.1f, -0.2f, 0.9f}, {0.0f, 0.0f, -1.0f}, 1.1f, scene.bounds_min, scene.bounds_max);
  testing::internal::CaptureStderr();
  const Rendered r = render(context(), scene, camera, picture_options(Gi("hybrid"), {32, 32}));
  EXPECT_NE(testing::internal::GetCapturedStderr().find("keeps its light for ever"), std::string::npos);
  EXPECT_TRUE(r.report.of<screen::VolumeReport>().bounces.converged);
  for (const glm::vec3& p : r.image.pixels) ASSERT_TRUE(p.x >= 0.0f && p.x < 100.0f);
}

}  // namespace
}  // namespace volgi::test
