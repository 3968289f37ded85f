// Hundreds of bounces between walls that absorb a hundredth (docs/hard-cases.md, "long", "furnace").
#include <gtest/gtest.h>

#include <cmath>

#include "tests/hardcases/frame_case.h"
#include "tests/support/frame_picture.h"
#include "tests/support/gl_test.h"
#include "tests/support/invariance.h"
#include "tests/support/volume_scenes.h"

namespace volgi::test {
namespace {

constexpr float kAlbedo = 0.99f;

class Long : public GlTest {
 protected:
  struct Answer {
    double sent;   // power that sides send in all [W]
    double shown;  // mean of the picture over L_e / (1 - rho)
  };
  /// A closed box whose walls emit 1.
  static Answer furnace(const VolumeOptions& volume, float albedo = kAlbedo) {
    Scene scene;
    add_box_inside(scene, add_material(scene, glm::vec3(albedo), glm::vec3(1.0f)), glm::vec3(0.0f), glm::vec3(1.0f));
    screen::FrameOptions o;
    o.recipe = "volume";
    o.size = {24, 24};
    o.of<VolumeOptions>() = volume;
    o.bounces = volume.bounces;
    o.of<VolumeOptions>().grid_cells = 12;
    const Camera camera =
        look_at_camera({0.3f, 0.2f, 0.7f}, {-0.4f, -0.3f, -1.0f}, 1.2f, scene.bounds_min, scene.bounds_max);
    const Rendered r = render(context(), scene, camera, o);
    return {double(r.report.of<screen::VolumeReport>().bounces.sent.x), mean_light(r.image) * (1.0 - double(albedo))};
  }
};

TEST_F(Long, PlainBouncesAreTheGeometricSeries) {
  double last = 0.0;
  for (int bounces : {1, 20, 100, 500}) {
    VolumeOptions volume;
    volume.solver = BounceRules::Solver::plain;
    volume.bounces = bounces;
    const double sent = furnace(volume).sent;
    const double rho = double(kAlbedo);
    const double off = sent / (24.0 * M_PI) * (1.0 - rho) - (1.0 - std::pow(rho, bounces + 1));
    expect_of_frame("long", fmt::format("volume ordinates, {} plain bounces against the geometric series", bounces),
                    100.0 * std::abs(off), 0.1);
    EXPECT_GT(sent, last);
    last = sent;
  }
}

TEST_F(Long, IterationsApproachTheLimitFromBelow) {
  const bool on_cpu = tested_backend() == screen::Backend::cpu;  // on a GPU in software these take a minute
  double last = 0.0;
  for (int iterations : {20, 200, on_cpu ? 2000 : 400}) {
    VolumeOptions volume;
    volume.scheme.scheme = Scheme::conservative;
    volume.iterations = iterations;
    const double shown = furnace(volume).shown;
    EXPECT_GT(shown, last) << iterations;
    EXPECT_LT(shown, 1.0) << iterations;
    last = shown;
  }
  EXPECT_GT(last, on_cpu ? 0.8 : 0.2);  // 0.816 after 2000
}

TEST_F(Long, FurnaceOfWhiteWalls) {
  VolumeOptions volume;
  expect_of_frame("furnace", "volume ordinates, albedo 0.99, one picture", off_percent(furnace(volume).shown), 2.0);
}

// 30,000 passes, which the CPU makes in a second. As seen in one picture: whole walls are in furnace_test.cpp.
TEST_F(Long, ConservativeFurnaceOfWhiteWallsNotInSoftware) {
  if (const char* reason = reason_to_skip(TestedOn::not_in_software, context())) GTEST_SKIP() << reason;
  VolumeOptions volume;
  volume.scheme.scheme = Scheme::conservative;
  expect_of_frame("furnace", "volume conservative, albedo 0.99, one picture", off_percent(furnace(volume).shown), 2.0);
}

}  // namespace
}  // namespace volgi::test
