// Once a frame runs as the one before, it makes no GL object: no allocation, no compilation in the middle of a picture.
#include "core/gl/objects.h"
#include "tests/screen/screen_scene.h"
#include "tests/support/frame_picture.h"
#include "tests/support/gl_test.h"

namespace volgi::test {
namespace {

struct Setting {
  const char* name;
  screen::GiMode gi;
  screen::Backend backend = screen::Backend::gpu;
};

class SteadyFrame : public GlTest, public testing::WithParamInterface<Setting> {};

TEST_P(SteadyFrame, MakesNoObjects) {
  Scene scene = stage();
  scene.materials.push_back(scene.materials[0]);
  scene.materials.back().emissive_radiance = glm::vec3(2.0f);
  add_quad(scene, int(scene.materials.size()) - 1, {1.0f, 1.5f, -1.0f}, {0.0f, 0.0f, 0.4f}, {0.4f, 0.0f, 0.0f});
  scene.lights = {spot_light({0.0f, 2.5f, 1.5f}, {0.0f, -1.0f, -0.5f}, 20.0f, 40.0f, 30.0f),
                  point_light({-1.0f, 1.8f, 0.5f}, 5.0f), sun_light({0.2f, -1.0f, -0.3f}, 1.0f)};
  update_bounds(scene);
  screen::FrameOptions options;
  options.gi = GetParam().gi;
  options.backend = GetParam().backend;
  options.size = glm::ivec2(48);
  options.shadow_resolution = {64, 32, 64};
  options.volume.grid_cells = 8;
  options.virtual_lights.count = 64;
  options.negative_lights.count = 16;
  options.area_lights.count = 16;
  options.area_light_map = 32;
  screen::Frame frame(scene, options);
  gl::PassTimer timer(context().software(), false);
  const auto made_in_next_frame = [&] {
    const std::uint64_t before = gl::objects_made();
    timer.begin_frame();
    frame.render(stage_camera(scene), timer);
    timer.end_frame();
    return gl::objects_made() - before;
  };
  made_in_next_frame();
  made_in_next_frame();
  for (int f = 3; f <= 5; ++f) EXPECT_EQ(made_in_next_frame(), 0u) << "frame " << f;
}

INSTANTIATE_TEST_SUITE_P(, SteadyFrame,
                         testing::Values(Setting{"none", screen::GiMode::none},
                                         Setting{"volume", screen::GiMode::volume},
                                         Setting{"volume_on_cpu", screen::GiMode::volume, screen::Backend::cpu},
                                         Setting{"vpl", screen::GiMode::vpl},
                                         Setting{"negative", screen::GiMode::negative},
                                         Setting{"val", screen::GiMode::val}, Setting{"hybrid", screen::GiMode::hybrid},
                                         Setting{"hybrid_on_cpu", screen::GiMode::hybrid, screen::Backend::cpu}),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace volgi::test
