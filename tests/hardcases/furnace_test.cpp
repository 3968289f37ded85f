// A closed box whose walls emit L_e and reflect rho shows L_e / (1 - rho) everywhere. Pixels away from edges; upright
// within 1 %, turned within 3 %. And the report's power balance: what is injected is what surfaces send.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/hardcases/frame_case.h"
#include "tests/support/frame_picture.h"
#include "tests/support/gl_test.h"
#include "tests/support/volume_scenes.h"

namespace volgi::test {
namespace {

class Furnace : public GlTest {
 protected:
  /// Mean over the pixels whose 5x5 neighbours lie on the same wall.
  static double wall_mean(float albedo, const glm::mat3& turn, int grid_cells, Scheme scheme) {
    Scene scene;
    scene.name = "furnace";
    add_box_inside(scene, add_material(scene, glm::vec3(albedo), glm::vec3(1.0f)), glm::vec3(0.0f), glm::vec3(1.0f),
                   turn);
    Camera camera = look_at_camera(turn * glm::vec3(0.3f, 0.2f, 0.7f), turn * glm::vec3(-0.4f, -0.3f, -1.0f), 1.2f,
                                   scene.bounds_min, scene.bounds_max);
    screen::FrameOptions options;
    options.recipe = "volume";
    options.size = {64, 64};
    options.of<VolumeOptions>().grid_cells = grid_cells;
    options.of<VolumeOptions>().scheme.scheme = scheme;
    Rendered r = render(context(), scene, camera, options);
    EXPECT_EQ(r.report.of<screen::VolumeReport>().lost, glm::vec3(0.0f));
    EXPECT_NEAR(r.report.of<screen::VolumeReport>().injected.x, 24.0 * M_PI, 24.0 * M_PI * 1e-4);  // 24 m^2 of pi L_e
    double sum = 0.0;
    int count = 0;
    for (int y = 2; y < 62; ++y) {
      for (int x = 2; x < 62; ++x) {
        const int wall = wall_of(camera, turn, {x, y});
        bool inside = true;
        for (int k = 0; k < 25; ++k) inside = inside && wall_of(camera, turn, {x + k % 5 - 2, y + k / 5 - 2}) == wall;
        if (!inside) continue;
        sum += r.image.at(x, y).x;
        count += 1;
      }
    }
    EXPECT_GT(count, 1500);
    return sum / count;
  }

  /// Mean over all six walls: seen from the middle, pixels are equal areas of a wall.
  static double whole_walls_mean(float albedo, int grid_cells, Scheme scheme) {
    Scene scene;
    scene.name = "furnace";
    add_box_inside(scene, add_material(scene, glm::vec3(albedo), glm::vec3(1.0f)), glm::vec3(0.0f), glm::vec3(1.0f));
    screen::FrameOptions options;
    options.recipe = "volume";
    options.size = {24, 24};
    options.of<VolumeOptions>().grid_cells = grid_cells;
    options.of<VolumeOptions>().scheme.scheme = scheme;
    options.backend = tested_backend();
    screen::Frame frame(scene, options);
    gl::PassTimer timer(context().software(), false);
    double sum = 0.0;
    for (int face = 0; face < 6; ++face) {
      const glm::vec3 target = glm::vec3(shared::face_step(face));
      frame.render(look_at_camera(glm::vec3(0.0f), target, float(M_PI_2), scene.bounds_min, scene.bounds_max), timer);
      for (const glm::vec3& p : screen::image_from_texture(frame.radiance()).pixels) sum += p.x;
    }
    return sum / (6.0 * 24.0 * 24.0);
  }

 private:
  /// Number of the wall that the pixel's ray meets first.
  static int wall_of(const Camera& camera, const glm::mat3& turn, glm::ivec2 pixel) {
    const CameraRay ray = camera_ray(camera, glm::vec2(pixel) + 0.5f, {64, 64});
    const glm::vec3 o = glm::transpose(turn) * ray.origin;
    const glm::vec3 d = glm::transpose(turn) * ray.direction;
    int best = 0;
    float nearest = 1e30f;
    for (int axis = 0; axis < 3; ++axis) {
      const float t = ((d[axis] > 0.0f ? 1.0f : -1.0f) - o[axis]) / d[axis];
      if (t < nearest) {
        nearest = t;
        best = 2 * axis + (d[axis] > 0.0f ? 1 : 0);
      }
    }
    return best;
  }
};

TEST_F(Furnace, UprightOrdinates) {
  for (float albedo : {0.0f, 0.5f, 0.8f, 0.95f}) {
    const double shown = wall_mean(albedo, glm::mat3(1.0f), 16, Scheme::ordinates) * double(1.0f - albedo);
    expect_of_frame("furnace", fmt::format("volume ordinates, albedo {}, pixels inside of walls", albedo),
                    off_percent(shown), 1.0);
  }
}

TEST_F(Furnace, UprightConservative) {
  // Its pulses are brighter in the middle of walls than at their edges: the mean is over whole walls.
  for (float albedo : {0.0f, 0.5f, 0.8f}) {
    const double shown = whole_walls_mean(albedo, 12, Scheme::conservative) * double(1.0f - albedo);
    expect_of_frame("furnace", fmt::format("volume conservative, albedo {}, whole walls", albedo), off_percent(shown),
                    1.0);
  }
}

TEST_F(Furnace, UprightConservativeOfWhiteWallsNotInSoftware) {
  if (const char* reason = reason_to_skip(TestedOn::not_in_software, context())) GTEST_SKIP() << reason;
  for (const auto& [albedo, limit] : {std::pair(0.95f, 1.0), {0.99f, 2.0}}) {
    const double shown = whole_walls_mean(albedo, 12, Scheme::conservative) * double(1.0f - albedo);
    expect_of_frame("furnace", fmt::format("volume conservative, albedo {}, whole walls", albedo), off_percent(shown),
                    limit);
  }
}

TEST_F(Furnace, TurnedOrdinates) {
  const glm::mat3 about_y = rotation({0, 1, 0}, 45.0f);
  const glm::mat3 all_ways = rotation({1, 0, 0}, 30.0f) * rotation({0, 1, 0}, 20.0f) * rotation({0, 0, 1}, 10.0f);
  for (float albedo : {0.5f, 0.8f}) {
    for (const auto& [turn, name] : {std::pair(about_y, "45° about Y"), {all_ways, "(30°, 20°, 10°)"}}) {
      const double shown = wall_mean(albedo, turn, 32, Scheme::ordinates) * double(1.0f - albedo);
      expect_of_frame("tilt", fmt::format("furnace turned by {}, volume ordinates, albedo {}", name, albedo),
                      off_percent(shown), 3.0);
    }
  }
}

// In the middle of walls; whole walls are in cavity_test.cpp.
TEST_F(Furnace, TurnedConservative) {
  const glm::mat3 about_y = rotation({0, 1, 0}, 45.0f);
  for (float albedo : {0.5f, 0.8f}) {
    const double shown = wall_mean(albedo, about_y, 20, Scheme::conservative) * double(1.0f - albedo);
    expect_of_frame("tilt", fmt::format("furnace turned by 45° about Y, volume conservative, albedo {}", albedo),
                    off_percent(shown), 3.0);
  }
}

// 3 % is missed (docs/results/where-we-miss.md).
TEST_F(Furnace, TurnedAllWaysConservativeNotInSoftware) {
  if (const char* reason = reason_to_skip(TestedOn::not_in_software, context())) GTEST_SKIP() << reason;
  const glm::mat3 all_ways = rotation({1, 0, 0}, 30.0f) * rotation({0, 1, 0}, 20.0f) * rotation({0, 0, 1}, 10.0f);
  for (const auto& [albedo, limit] : {std::pair(0.5f, 4.2), {0.8f, 6.1}}) {
    const double shown = wall_mean(albedo, all_ways, 32, Scheme::conservative) * double(1.0f - albedo);
    expect_of_frame("tilt", fmt::format("furnace turned by (30°, 20°, 10°), volume conservative, albedo {}", albedo),
                    off_percent(shown), limit, 3.0, "pulses are brighter in the middle of walls than at their edges");
  }
}

}  // namespace
}  // namespace volgi::test
