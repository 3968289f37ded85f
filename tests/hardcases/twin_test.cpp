// End to end, from a scene to the power that its sides send: the GPU's volume, lit through shadow maps, against the
// CPU's, lit by rays (docs/hard-cases.md, "twin"). Stage by stage: tests/crosscheck.
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/hardcases/frame_case.h"
#include "tests/support/frame_picture.h"
#include "tests/support/gl_test.h"
#include "tests/support/paths.h"

namespace volgi::test {
namespace {

class Twin : public GlTest {
 protected:
  static screen::VolumeReport report(const Scene& scene, screen::Backend backend) {
    screen::FrameOptions options;
    options.recipe = "volume";
    options.size = {16, 16};
    options.backend = backend;
    options.of<VolumeOptions>().scheme.directions = 24;
    options.bounces = 16;  // the same orders: where a solver stops, within 0.2 %, is not compared
    screen::Frame frame(scene, options);
    gl::PassTimer timer(context().software(), false);
    frame.render(scene.cameras.at(0), timer);
    return frame.report().of<screen::VolumeReport>();
  }
};

TEST_F(Twin, TotalPower) {
  const std::filesystem::path data = source_dir() / "data";
  for (const char* name : {"cornell", "room", "thin_wall", "emissive"}) {
    const Scene scene = load_scene(data / (std::string(name) + ".glb"));
    const screen::VolumeReport gpu = report(scene, screen::Backend::gpu);
    const screen::VolumeReport cpu = report(scene, screen::Backend::cpu);
    EXPECT_TRUE(gpu.on_gpu);
    EXPECT_FALSE(cpu.on_gpu);
    EXPECT_EQ(gpu.sides, cpu.sides) << name;
    double worst = 0.0;
    for (int band = 0; band < 3; ++band) {
      worst = std::max({worst, off_percent(double(cpu.injected[band]) / double(gpu.injected[band])),
                        off_percent(double(cpu.bounces.sent[band]) / double(gpu.bounces.sent[band]))});
    }
    expect_hard_case({"twin", fmt::format("volume, {}, power injected and sent", name), "both", worst, 0.1, {}},
                     context().software());
  }
}

// The papers' schemes have pictures on both backends, and no direct light to show.
TEST_F(Twin, PapersSchemes) {
  const Scene scene = load_scene(source_dir() / "data/emissive.glb");
  for (Scheme scheme : {Scheme::lpv2009, Scheme::gaitatzes2010}) {
    for (screen::LightPart light : {screen::LightPart::indirect, screen::LightPart::direct}) {
      double sums[2] = {};
      for (screen::Backend backend : {screen::Backend::gpu, screen::Backend::cpu}) {
        screen::FrameOptions options;
        options.recipe = "volume";
        options.size = {32, 32};
        options.backend = backend;
        options.light = light;
        options.of<VolumeOptions>().grid_cells = 16;
        options.of<VolumeOptions>().scheme.scheme = scheme;
        screen::Frame frame(scene, options);
        gl::PassTimer timer(context().software(), false);
        frame.render(scene.cameras.at(0), timer);
        for (const glm::vec3& p : screen::image_from_texture(frame.radiance()).pixels)
          sums[backend == screen::Backend::cpu ? 1 : 0] += double(p.x + p.y + p.z);
      }
      EXPECT_GT(sums[0], 0.0);  // direct: emission seen by the camera
      EXPECT_NEAR(sums[1] / sums[0], 1.0, 0.01);
    }
  }
}

}  // namespace
}  // namespace volgi::test
