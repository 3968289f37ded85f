// Pictures by nested grids: near the camera those of one fine grid, and a clear word where there are none.
#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "tests/support/frame_picture.h"
#include "tests/support/gl_test.h"
#include "tests/support/volume_scenes.h"

namespace volgi::test {
namespace {

class CascadeGl : public GlTest {
 protected:
  /// A street between rows of houses under an even sky, with a lamp.
  static Scene street() {
    Scene scene;
    const int grey = add_material(scene, glm::vec3(0.5f));
    add_quad(scene, grey, {-20.0f, 0.0f, -10.0f}, {0.0f, 0.0f, 20.0f}, {40.0f, 0.0f, 0.0f});
    for (const float z : {-6.0f, 6.0f}) add_box(scene, grey, {0.0f, 2.5f, z}, {18.0f, 2.5f, 2.0f});
    scene.lights.push_back(point_light({1.0f, 4.0f, 0.5f}, glm::vec3(20.0f)));
    scene.sky = std::make_shared<Sky>(glm::vec3(0.5f));
    return scene;
  }
  static screen::FrameOptions options(Gi gi, int cells, int levels) {
    screen::FrameOptions o;
    screen::apply_recipe(std::string(gi), o);
    o.size = {32, 32};
    o.light = screen::LightPart::indirect;
    o.backend = screen::Backend::cpu;
    o.of<VolumeOptions>().grid_cells = cells;
    o.of<VolumeOptions>().cascade.levels = levels;
    o.of<VolumeOptions>().scheme.directions = 128;
    o.of<VolumeOptions>().scheme.ordinates = Ordinates::characteristic;
    return o;
  }
  static Image picture(const Scene& scene, const screen::FrameOptions& o) {
    const Camera camera =
        look_at_camera({-1.0f, 1.7f, 0.3f}, {0.8f, 0.0f, -0.5f}, 0.9f, scene.bounds_min, scene.bounds_max);
    screen::Frame frame(scene, o);
    gl::PassTimer timer(context().software(), false);
    frame.render(camera, timer);
    return screen::image_from_texture(frame.radiance());
  }
};

// What is seen is in the innermost grid; the bounds are whole cells of both, so that surfaces lie in the same cells.
TEST_F(CascadeGl, PicturesAreThoseOfOneFineGrid) {
  const Scene scene = street();
  for (const Gi gi : {"volume", "hybrid"}) {
    const Image one = picture(scene, options(gi, 96, 1)), nested = picture(scene, options(gi, 24, 3));
    double truth = 0.0, found = 0.0, squares = 0.0;
    for (size_t i = 0; i < one.pixels.size(); ++i) {
      truth += double(one.pixels[i].x);
      found += double(nested.pixels[i].x);
      squares += std::pow(double(one.pixels[i].x - nested.pixels[i].x), 2.0);
    }
    const auto count = double(one.pixels.size());
    EXPECT_GT(truth, 0.0);
    EXPECT_NEAR(found / truth, 1.0, 0.02) << gi;
    EXPECT_LT(std::sqrt(squares / count) / (truth / count), 0.05) << gi;
  }
}

TEST_F(CascadeGl, TheGpuSaysThatItHasNone) {
  const Scene scene = street();
  screen::FrameOptions o = options("volume", 16, 2);
  o.backend = screen::Backend::gpu;
  try {
    picture(scene, o);
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ExitCode::usage);
    EXPECT_NE(std::string(e.what()).find("--backend cpu"), std::string::npos);
  }
}

}  // namespace
}  // namespace volgi::test
