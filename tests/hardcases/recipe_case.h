#pragma once
// What tests share that go through the list of recipes.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "screen/lights/lattice/wave_lattice.h"
#include "tests/hardcases/frame_case.h"
#include "tests/support/gl_test.h"
#include "tests/support/paths.h"

namespace volgi::test {

inline std::vector<std::string> recipe_names() {
  std::vector<std::string> all;
  for (const screen::Recipe& recipe : screen::recipes()) all.emplace_back(recipe.name);
  return all;
}

inline bool has_volume(const std::string& recipe_name) {
  const screen::Recipe& recipe = screen::find_recipe(recipe_name);
  return std::any_of(recipe.stages.begin(), recipe.stages.end(),
                     [](const screen::StageType* s) { return s->slot == screen::Slot::bounces; });
}

/// Passes of recipes without a volume are the same on both backends: the GPU's run has them.
inline bool tested_on_gpu_alone(const std::string& recipe_name) {
  return tested_backend() == screen::Backend::cpu && !has_volume(recipe_name);
}

class RecipeTest : public GlTest, public testing::WithParamInterface<std::string> {
 protected:
  /// A scene that the recipe lights: `area` knows emissive surfaces alone.
  static std::filesystem::path file_for(const std::string& recipe) {
    return source_dir() / "data" / (recipe == "area" ? "emissive.glb" : "cornell.glb");
  }
  std::filesystem::path file() const { return file_for(GetParam()); }
  static screen::FrameOptions options_of(const std::string& recipe, glm::ivec2 size = {48, 48}) {
    screen::FrameOptions o = picture_options(recipe, size);
    o.of<VolumeOptions>().grid_cells = 12;
    o.of<screen::VirtualLightOptions>().count = 256;
    o.of<screen::WaveLatticeOptions>().angle_deg = 30.0f;
    return o;
  }
  screen::FrameOptions options() const { return options_of(GetParam()); }
  Image picture(const Scene& scene, bool serialised = false) const {
    screen::Frame frame(scene, options());
    gl::PassTimer timer(context().software(), false);
    if (serialised) timer.serialise_passes();
    frame.render(scene.cameras.at(0), timer);
    return screen::image_from_texture(frame.radiance());
  }
};

}  // namespace volgi::test
