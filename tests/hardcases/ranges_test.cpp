// Moonlight beside noon in one frame, and what textures of 16 bits lose against 32 (docs/hard-cases.md, "noon" and
// "storage"). Of every recipe.
#include <gtest/gtest.h>

#include <map>
#include <string>

#include "core/gl/storage.h"
#include "tests/hardcases/recipe_case.h"
#include "tests/support/invariance.h"
#include "tests/support/volume_scenes.h"

namespace volgi::test {
namespace {

constexpr glm::ivec2 kSize{64, 32};  // a box each half
constexpr float kNoonOverMoonlight = 1e5f;

/// Two boxes that are open towards the camera, so that nothing that leaves one comes into the other. A lamp in each.
Scene two_boxes(float left_w_sr, float right_w_sr, bool emissive) {
  Scene scene;
  const int grey = add_material(scene, glm::vec3(0.6f)), red = add_material(scene, {0.6f, 0.3f, 0.2f});
  for (const float side : {-1.0f, 1.0f}) {
    const float intensity = side < 0.0f ? left_w_sr : right_w_sr;
    const glm::vec3 c(1.3f * side, 0.0f, 0.0f);
    add_square(scene, grey, c - glm::vec3(0, 1, 0), {0, 1, 0}, 1.0f);
    add_square(scene, grey, c + glm::vec3(0, 1, 0), {0, -1, 0}, 1.0f);
    add_square(scene, red, c - glm::vec3(1, 0, 0), {1, 0, 0}, 1.0f);
    add_square(scene, red, c + glm::vec3(1, 0, 0), {-1, 0, 0}, 1.0f);
    add_square(scene, grey, c - glm::vec3(0, 0, 1), {0, 0, 1}, 1.0f);
    add_box(scene, grey, c - glm::vec3(0.2f, 0.7f, 0.1f), glm::vec3(0.3f));
    if (intensity == 0.0f) continue;
    if (emissive) {
      const int panel = add_material(scene, glm::vec3(0.5f), glm::vec3(intensity));
      add_square(scene, panel, c + glm::vec3(0.1f, 0.9f, 0.1f), {0, -1, 0}, 0.3f);
    } else {
      scene.lights.push_back(point_light(c + glm::vec3(0.2f, 0.5f, 0.3f), glm::vec3(intensity)));
    }
  }
  update_bounds(scene);
  scene.name = "two boxes";
  scene.cameras = {look_at_camera({0, 0, 4.2f}, {0, 0, 0}, 0.72f, scene.bounds_min, scene.bounds_max)};
  return scene;
}

/// The half of a picture that shows a box: 0 the left one, 1 the right one.
Image half(const Image& image, int which) {
  Image out(image.width / 2, image.height);
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x) out.at(x, y) = image.at(x + which * out.width, y);
  return out;
}

/// What a recipe is held to where 0.1 % is out of reach.
struct Measured {
  double limit_percent = 0.1;
  const char* cause = "";
};
using Limits = std::map<std::string, Measured>;

constexpr const char* ROUNDED =
    "which candidates become lights, and which a cluster, hangs on sums that rounding decides";
constexpr const char* SHARED_BY_POWER =
    "moonlight has 16 of 256 lights, and noon as many fewer: what of those shines through walls is 1e5 times as strong";
constexpr const char* OTHER_SAMPLES = "noon, which shines through walls 1e5 times as strong, is sampled otherwise";
constexpr const char* CANCELS = "a difference of two lights 3,000 times as strong, in single precision";

Measured find_limit(const Limits& limits, const std::string& recipe) {
  const auto found = limits.find(recipe);
  return found == limits.end() ? Measured{} : found->second;
}

const Limits ADDED{{"hybrid", {1250.0, SHARED_BY_POWER}},
                   {"val", {3100.0, SHARED_BY_POWER}},
                   {"negative", {30000.0, SHARED_BY_POWER}},
                   {"vpl", {25500.0, SHARED_BY_POWER}},
                   {"lattice", {1.05, OTHER_SAMPLES}},
                   {"multires", {0.25, CANCELS}},
                   {"radiosity", {0.3, CANCELS}},
                   {"hierarchical", {4.2, OTHER_SAMPLES}},
                   {"area", {78.0, OTHER_SAMPLES}},
                   {"lpv", {0.12, CANCELS}}};
const Limits OF_MOONLIGHT{{"hybrid", {9.1, ROUNDED}}, {"val", {2.0, ROUNDED}}};
const Limits OF_CORNELL{{"hybrid", {0.7, ROUNDED}}, {"val", {0.7, ROUNDED}}};

const Limits NEXT_DOOR{{"hybrid", {10.5, "16 of 256 lights, in a few clusters, and 1e-3 of the other room's light"}}};

class RangesOfRecipes : public RecipeTest {
 protected:
  Image of_size(const Scene& scene, glm::ivec2 size) const {
    return render(context(), scene, scene.cameras.at(0), options_of(GetParam(), size)).image;
  }
  static void expect(const char* row, const std::string& what, double percent, const Limits& limits) {
    const Measured m = find_limit(limits, GetParam());
    expect_of_frame(row, fmt::format("{}, {}", GetParam(), what), percent, m.limit_percent, 0.1, m.cause);
  }
};

// In the box that moonlight lights: what its lamp adds to the light of noon that comes there, through walls as well.
TEST_P(RangesOfRecipes, MoonlightBesideNoon) {
  if (tested_on_gpu_alone(GetParam())) return;
  const bool emissive = GetParam() == "area";
  const auto picture = [&](float left, float right) { return of_size(two_boxes(left, right, emissive), kSize); };
  const Image both = picture(kNoonOverMoonlight, 1.0f), noon = picture(kNoonOverMoonlight, 0.0f);
  const Image alone = half(picture(0.0f, 1.0f), 1);
  EXPECT_GT(mean_light(alone), 0.0);
  Image added = half(both, 1);
  const Image of_noon = half(noon, 1);
  for (size_t i = 0; i < added.pixels.size(); ++i) added.pixels[i] -= of_noon.pixels[i];
  expect("noon", "what moonlight adds", rmse_percent(added, alone), ADDED);
  const gl::WideStorage wide;
  const Image precise = picture(kNoonOverMoonlight, 1.0f);
  expect("storage", "two boxes, in noon", rmse_percent(half(both, 0), half(precise, 0)), {});
  expect("storage", "two boxes, in moonlight", rmse_percent(half(both, 1), half(precise, 1)), OF_MOONLIGHT);
}

// Of two lamps the weaker one keeps lights enough for the room that it alone lights: with three of 256, its share by
// power, the room is 17.5 % wrong.
TEST_P(RangesOfRecipes, AHundredTimesAsStrongNextDoor) {
  if (GetParam() != "hybrid") return;  // all recipes share virtual lights alike
  constexpr float strong = 100.0f;
  const Image both = of_size(two_boxes(strong, 1.0f, false), kSize);
  const Image alone = of_size(two_boxes(0.0f, 1.0f, false), kSize);
  expect("noon", "a room beside one lit 100 times", rmse_percent(half(both, 1), half(alone, 1)), NEXT_DOOR);
}

TEST_P(RangesOfRecipes, SixteenBitsAreEnough) {
  if (tested_on_gpu_alone(GetParam())) return;
  const Scene scene = load_scene(file());
  const Image narrow = of_size(scene, {48, 48});
  const gl::WideStorage wide;
  expect("storage", scene.name, rmse_percent(narrow, of_size(scene, {48, 48})), OF_CORNELL);
}

INSTANTIATE_TEST_SUITE_P(All, RangesOfRecipes, testing::ValuesIn(recipe_names()),
                         [](const auto& test) { return test.param; });

}  // namespace
}  // namespace volgi::test
