// What must not change the picture: the unit of length, where the scene lies, the strength of its lights.
#include <gtest/gtest.h>

#include <filesystem>
#include <vector>

#include "tests/hardcases/frame_case.h"
#include "tests/support/frame_picture.h"
#include "tests/support/gl_test.h"
#include "tests/support/invariance.h"
#include "tests/support/paths.h"
#include "tests/support/volume_scenes.h"

namespace volgi::test {
namespace {

namespace fs = std::filesystem;
const fs::path kData = source_dir() / "data";

class Invariance : public GlTest {
 protected:
  static screen::FrameOptions options(Scheme scheme = Scheme::ordinates) {
    screen::FrameOptions o;
    o.recipe = "volume";
    o.size = {64, 64};
    o.of<VolumeOptions>().grid_cells = 12;
    o.of<VolumeOptions>().scheme.scheme = scheme;
    return o;
  }
};

TEST_F(Invariance, Scale) {
  for (const char* name : {"cornell", "emissive", "room"}) {
    const Scene scene = load_scene(kData / (std::string(name) + ".glb"));
    const Image ref = render(context(), scene, scene.cameras.at(0), options()).image;
    for (float s : {1e-3f, 1e3f}) {
      const Scene other = scaled(scene, s);
      const double deviation = rmse_percent(render(context(), other, other.cameras.at(0), options()).image, ref);
      expect_of_frame("scale", fmt::format("volume, {} x {:g}", name, s), deviation, 0.1);
    }
  }
}

TEST_F(Invariance, Offset) {
  for (const char* name : {"cornell", "emissive"}) {
    const fs::path file = kData / (std::string(name) + ".glb");
    const Scene here = load_scene(file);
    const Scene there = load_moved(file, 1e5);
    EXPECT_GT(glm::length(there.world_origin - here.world_origin), 1e5);
    const Image ref = render(context(), here, here.cameras.at(0), options()).image;
    expect_of_frame("offset", fmt::format("volume, {}", name),
                    rmse_percent(render(context(), there, there.cameras.at(0), options()).image, ref), 0.1);
  }
}

TEST_F(Invariance, Range) {
  for (Scheme scheme : {Scheme::ordinates, Scheme::conservative}) {
    for (const char* name : {"cornell", "emissive"}) {
      const Scene scene = load_scene(kData / (std::string(name) + ".glb"));
      const Image ref = render(context(), scene, scene.cameras.at(0), options(scheme)).image;
      for (float factor : {1e-6f, 1e-3f, 1e4f, 1e9f}) {
        const Scene other = brighter(scene, factor);
        const Image test = render(context(), other, other.cameras.at(0), options(scheme)).image;
        expect_of_frame("range",
                        fmt::format("volume {}, {} x {:g}, worst pixel",
                                    scheme == Scheme::ordinates ? "ordinates" : "conservative", name, factor),
                        100.0 * worst_deviation(test, ref, double(factor)), 0.1);
      }
    }
  }
}

// Lights superpose: plain bounces of a linear operator. On tilted surfaces irradiance is clamped at zero where the
// staircase noise of a lit surface exceeds it; cornell has turned boxes.
TEST_F(Invariance, SumOfLights) {
  for (const char* name : {"convex_box", "cornell"}) {
    Scene scene = load_scene(kData / (std::string(name) + ".glb"));
    screen::FrameOptions o = options();
    o.bounces = 4;
    const Light a = scene.lights.at(0);
    const Light b = point_light({0.3f, -0.2f, 0.4f}, {0.5f, 1.0f, 2.0f});
    const auto lit_by = [&](std::vector<Light> lights) {
      scene.lights = std::move(lights);
      return render(context(), scene, scene.cameras.at(0), o).image;
    };
    const double deviation = rmse_percent(lit_by({a, b}), sum_of(lit_by({a}), lit_by({b})));
    expect_of_frame("sum", fmt::format("volume, {}", name), deviation, 0.1);
  }
}

}  // namespace
}  // namespace volgi::test
