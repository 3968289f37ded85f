// A camera close to a virtual light in a corner (docs/hard-cases.md, "corner"): the singularity of a light near a
// surface must not show.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "reference/metrics.h"
#include "reference/path_tracer.h"
#include "tests/hardcases/frame_case.h"
#include "tests/support/frame_picture.h"
#include "tests/support/gl_test.h"
#include "tests/support/invariance.h"
#include "tests/support/volume_scenes.h"

namespace volgi::test {
namespace {

constexpr glm::ivec2 kSize{64, 64};
constexpr glm::vec3 kCorner{-1.0f};

/// A room of 2 m, one of whose corners a spot lights.
Scene lit_corner() {
  Scene scene;
  add_box_inside(scene, add_material(scene, {0.8f, 0.7f, 0.6f}), glm::vec3(0.0f), glm::vec3(1.0f));
  const glm::vec3 lamp(0.1f, -0.1f, 0.2f);
  scene.lights.push_back(spot_light(lamp, kCorner - lamp, 12.0f, 16.0f, glm::vec3(5.0f)));
  return scene;
}

float maximum(const Image& image) {
  float largest = 0.0f;
  for (const glm::vec3& p : image.pixels) largest = std::max({largest, p.x, p.y, p.z});
  return largest;
}

class Corner : public GlTest {
 protected:
  static screen::FrameOptions options(Gi gi, int count) {
    screen::FrameOptions o = picture_options(gi, kSize, screen::LightPart::indirect);
    o.of<screen::VirtualLightOptions>().count = count;
    return o;
  }

  /// `distance_m` in front of the virtual light nearest to the corner, of those chosen for a camera that sees it.
  static Camera close_to_a_light(const Scene& scene, int count, float distance_m, glm::vec3 target) {
    screen::Frame frame(scene, options(Gi("vpl"), count));
    gl::PassTimer timer(context().software(), false);
    frame.render(look_at_camera(glm::vec3(0.3f), kCorner, 1.0f, scene.bounds_min, scene.bounds_max), timer);
    const VirtualLightList list = frame.virtual_lights();
    const auto nearer = [](const shared::VirtualLight& a, const shared::VirtualLight& b) {
      return glm::distance(a.position, kCorner) < glm::distance(b.position, kCorner);
    };
    const shared::VirtualLight light = *std::min_element(list.lights.begin(), list.lights.end(), nearer);
    return look_at_camera(light.position + distance_m * light.normal, target, 1.2f, scene.bounds_min, scene.bounds_max);
  }

  /// Of means of 4 x 4 pixels, lest its noise be the maximum.
  static float brightest_by_paths(const Scene& scene, const Camera& camera, std::optional<int> bounces) {
    PathTracerOptions o;
    o.size = kSize;
    o.samples_per_pixel = 32;
    o.max_bounces = bounces;
    o.light = PathTracerOptions::Light::indirect;
    return maximum(box_downsample(path_trace(scene, camera, o).color, kSize.x / 4, kSize.y / 4));
  }
};

// Measured: 1.23 at most (vpl and negative), 1.27 (val), 1.66 (hybrid), where lights that are chosen several times
// stay as large as they are; 2.2 to 3.4 times where they shrank. hybrid's 1.66 is a pixel within 1.5 mm of the corner,
// which is the spot's axis: the curve's pieces are long and thin there, and sixteen of their samples lie on an arc.
TEST_F(Corner, NoPixelIsTwiceAsBrightAsTheBrightest) {
  const Scene scene = lit_corner();
  for (const auto& [count, distance_m, target] :
       {std::tuple(1024, 0.05f, kCorner), {1024, 0.005f, glm::vec3(-0.7f, -1.0f, -0.9f)}, {64, 0.05f, kCorner}}) {
    const Camera camera = close_to_a_light(scene, count, distance_m, target);
    const float first_bounce = brightest_by_paths(scene, camera, 1);
    const float all_bounces = brightest_by_paths(scene, camera, std::nullopt);
    for (const Gi mode : {"vpl", "negative", "val", "hybrid", "multires", "radiosity", "hierarchical", "lattice"}) {
      if (tested_backend() == screen::Backend::cpu && mode != "hybrid") continue;  // no volume: the same passes
      const bool has_one_light_near = mode == "vpl" || mode == "negative" || mode == "val" || mode == "hybrid";
      if (!has_one_light_near && count != 64) continue;  // lights of a grid or in the air are not those of the camera
      const Image image = render(context(), scene, camera, options(mode, count)).image;
      EXPECT_GT(mean_light(image), 0.0);
      const float ratio = maximum(image) / (mode == "hybrid" || mode == "lattice" ? all_bounces : first_bounce);
      expect_of_frame("corner", fmt::format("{}, {} lights, {} m", mode, count, distance_m), double(ratio), 2.0, {}, {},
                      "times the brightest");
    }
  }
}

}  // namespace
}  // namespace volgi::test
