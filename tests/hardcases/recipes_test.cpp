// What holds of every recipe that there is: the same bytes twice and with passes that wait for one another, and the
// rows "scale", "offset", "range" and "sum" of docs/hard-cases.md where no other test has them.
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <string>

#include "screen/lights/lattice/wave_lattice.h"
#include "tests/hardcases/frame_case.h"
#include "tests/support/gl_test.h"
#include "tests/support/invariance.h"
#include "tests/support/paths.h"
#include "tests/support/volume_scenes.h"

namespace volgi::test {
namespace {

std::vector<std::string> names() {
  std::vector<std::string> all;
  for (const screen::Recipe& recipe : screen::recipes()) all.emplace_back(recipe.name);
  return all;
}

class Recipes : public GlTest, public testing::WithParamInterface<std::string> {
 protected:
  /// Passes of recipes without a volume are the same on both: once is enough.
  static bool has_been_tested() {
    const screen::Recipe& recipe = screen::find_recipe(GetParam());
    const bool has_volume = std::any_of(recipe.stages.begin(), recipe.stages.end(),
                                        [](const screen::StageType* s) { return s->slot == screen::Slot::bounces; });
    return tested_backend() == screen::Backend::cpu && !has_volume;
  }
  std::filesystem::path file() const {
    return source_dir() / "data" / (GetParam() == "area" ? "emissive.glb" : "cornell.glb");
  }
  screen::FrameOptions options() const {
    screen::FrameOptions o = picture_options(GetParam(), {48, 48});
    o.of<VolumeOptions>().grid_cells = 12;
    o.of<screen::VirtualLightOptions>().count = 256;
    o.of<screen::WaveLatticeOptions>().angle_deg = 30.0f;
    return o;
  }
  Image picture(const Scene& scene, bool serialised = false) const {
    screen::Frame frame(scene, options());
    gl::PassTimer timer(context().software(), false);
    if (serialised) timer.serialise_passes();
    frame.render(scene.cameras.at(0), timer);
    return screen::image_from_texture(frame.radiance());
  }
  /// Recipes whose rows the other tests have.
  bool is_tested_elsewhere() const {
    constexpr std::array elsewhere{"volume", "vpl", "negative", "val", "hybrid"};
    return std::find(elsewhere.begin(), elsewhere.end(), GetParam()) != elsewhere.end();
  }
};

TEST_P(Recipes, PassesDoNotRace) {
  if (has_been_tested()) return;
  const Scene scene = load_scene(file());
  const Image once = picture(scene), again = picture(scene), serialised = picture(scene, true);
  EXPECT_GT(mean_light(once), 0.0);
  EXPECT_TRUE(once.pixels == again.pixels) << "two frames of the same scene differ";
  EXPECT_TRUE(once.pixels == serialised.pixels) << "a barrier is missing between two passes";
}

TEST_P(Recipes, ScaleOffsetAndRange) {
  if (has_been_tested() || is_tested_elsewhere()) return;
  const Scene scene = load_scene(file());
  const Image ref = picture(scene);
  for (const float s : {1e-3f, 1e3f})
    expect_of_frame("scale", fmt::format("{}, {} x {:g}", GetParam(), scene.name, s),
                    rmse_percent(picture(scaled(scene, s)), ref), 0.1);
  expect_of_frame("offset", fmt::format("{}, {}", GetParam(), scene.name),
                  rmse_percent(picture(load_moved(file(), 1e5)), ref), 0.1);
  for (const float factor : {1e-6f, 1e9f})
    expect_of_frame("range", fmt::format("{}, {} x {:g}, RMSE", GetParam(), scene.name, factor),
                    rmse_percent(picture(brighter(scene, factor)), ref, double(factor)), 0.1);
}

TEST_P(Recipes, SumOfLights) {
  if (has_been_tested() || GetParam() == "area" ||
      (is_tested_elsewhere() && GetParam() != "val" && GetParam() != "hybrid"))
    return;
  Scene scene = load_scene(file());
  const Light a = scene.lights.at(0), b = point_light({0.3f, -0.2f, 0.4f}, {0.5f, 1.0f, 2.0f});
  const auto lit_by = [&](std::vector<Light> lights) {
    scene.lights = std::move(lights);
    return picture(scene);
  };
  const double deviation = rmse_percent(lit_by({a, b}), sum_of(lit_by({a}), lit_by({b})));
  // 0.1 % is asked of those whose lights do not depend on one another; of the others the figure is wanted.
  const std::map<std::string, double> reported{{"hybrid", 2.0}, {"val", 6.0}, {"lattice", 0.8}};
  const auto of_this = reported.find(GetParam());
  expect_of_frame("sum", fmt::format("{}, {}", GetParam(), scene.name), deviation,
                  of_this == reported.end() ? 0.1 : of_this->second);
}

INSTANTIATE_TEST_SUITE_P(All, Recipes, testing::ValuesIn(names()), [](const auto& test) { return test.param; });

}  // namespace
}  // namespace volgi::test
