// Once a frame runs as the one before, it makes no GL object: no allocation, no compilation in the middle of a picture.
#include "core/gl/objects.h"
#include "screen/lights/patches/light_patches.h"
#include "tests/screen/screen_scene.h"
#include "tests/support/frame_picture.h"
#include "tests/support/gl_test.h"

namespace volgi::test {
namespace {

struct Setting {
  const char* name;
  Gi gi;
  screen::Backend backend = screen::Backend::gpu;
  std::vector<std::string> set = {};
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
  screen::apply_recipe(std::string(GetParam().gi), options);
  options.backend = GetParam().backend;
  options.size = glm::ivec2(48);
  options.of<screen::ReflectiveShadowMap::Resolution>() = {64, 32, 64};
  options.of<VolumeOptions>().grid_cells = 8;
  options.of<screen::VirtualLightOptions>().count = 64;
  options.of<screen::NegativeLightOptions>().count = 16;
  options.of<screen::VirtualAreaLightOptions>().count = 16;
  options.of<screen::AreaMapOptions>().texels = 32;
  options.of<screen::LightPatchOptions>().grid = 4;
  for (const std::string& set : GetParam().set) screen::set_parameter(options.settings, set);
  options.bounces = 2;
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

INSTANTIATE_TEST_SUITE_P(
    , SteadyFrame,
    testing::Values(
        Setting{"none", Gi("none")}, Setting{"volume", Gi("volume")},
        Setting{"volume_on_cpu", Gi("volume"), screen::Backend::cpu}, Setting{"vpl", Gi("vpl")},
        Setting{"negative", Gi("negative")}, Setting{"val", Gi("val")}, Setting{"area", Gi("area")},
        Setting{"hybrid", Gi("hybrid")}, Setting{"hybrid_on_cpu", Gi("hybrid"), screen::Backend::cpu},
        Setting{"multires", Gi("multires")}, Setting{"radiosity", Gi("radiosity")},
        Setting{"hierarchical", Gi("hierarchical")},
        Setting{"splat", Gi("multires"), screen::Backend::gpu, {"multires.sum=splat"}},
        Setting{"splat_by_compute",
                Gi("multires"),
                screen::Backend::gpu,
                {"multires.sum=splat", "multires.refine=compute", "multires.visibility=area_maps"}},
        Setting{"splat_each", Gi("multires"), screen::Backend::gpu, {"multires.sum=splat", "multires.each_light=on"}}),
    [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace volgi::test
