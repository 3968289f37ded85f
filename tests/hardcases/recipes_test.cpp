// What holds of every recipe that there is: the same bytes twice and with passes that wait for one another, the rows
// "units" and "split" of docs/hard-cases.md, and "scale", "offset", "range" and "sum" where no other test has them.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>

#include "core/exposure.h"
#include "tests/hardcases/recipe_case.h"
#include "tests/support/invariance.h"
#include "tests/support/volume_scenes.h"

namespace volgi::test {
namespace {

class Recipes : public RecipeTest {
 protected:
  bool has_been_tested() const { return tested_on_gpu_alone(GetParam()); }
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

constexpr const char* OTHER_LIGHTS =
    "which candidates become lights, and which a cluster, hangs on sums that rounding decides";

/// As `volgi render` makes it of a picture: exposed by its own light, toned, in 8 bits.
std::vector<int> png_bytes(const Image& image) {
  const float ev = automatic_exposure_ev(image);
  std::vector<int> bytes;
  for (const glm::vec3& p : image.pixels) {
    const glm::vec3 shown = tone_map(p * std::exp2(ev));
    for (int c = 0; c < 3; ++c) bytes.push_back(int(std::lround(255.0f * srgb_encode(shown[c]))));
  }
  return bytes;
}

/// Root mean square of differences, in steps of 255.
double steps_between(const std::vector<int>& a, const std::vector<int>& b) {
  double squares = 0.0;
  for (size_t i = 0; i < a.size(); ++i) squares += double((a[i] - b[i]) * (a[i] - b[i]));
  return std::sqrt(squares / double(a.size()));
}

// The same pictures answer for three rows: "scale" and "range" where no other test has them, and "units". Exposures are
// rounded to 0.01 stops, which is up to half a step.
TEST_P(Recipes, InAnyUnit) {
  if (has_been_tested()) return;
  // The GPU's volume has the rows of its own (invariance_test.cpp), which take seconds in software.
  if (is_tested_elsewhere() && has_volume(GetParam()) &&
      reason_to_skip(TestedOn::not_in_software, context()) != nullptr)
    return;
  const bool by_lights = GetParam() == "val" || GetParam() == "hybrid";
  const Scene scene = load_scene(file());
  const Image ref = picture(scene);
  const std::vector<int> png = png_bytes(ref);
  const auto expect_the_same = [&](const char* row, const Scene& other, float by, float factor) {
    const Image image = picture(other);
    if (!is_tested_elsewhere())
      expect_of_frame(row, fmt::format("{}, {} x {:g}{}", GetParam(), scene.name, by, factor == 1.0f ? "" : ", RMSE"),
                      rmse_percent(image, ref, double(factor)), 0.1);
    expect_of_frame("units",
                    fmt::format("{}, {} x {:g}, PNG", GetParam(), row == std::string("scale") ? "metres" : "light", by),
                    steps_between(png_bytes(image), png), by_lights ? 1.5 : 1.0, 1.0, by_lights ? OTHER_LIGHTS : "",
                    "steps of 255");
  };
  for (const float s : {1e-3f, 1e3f}) expect_the_same("scale", scaled(scene, s), s, 1.0f);
  for (const float f : {1e-6f, 1e9f}) expect_the_same("range", brighter(scene, f), f, f);
  if (!is_tested_elsewhere())
    expect_of_frame("offset", fmt::format("{}, {}", GetParam(), scene.name),
                    rmse_percent(picture(load_moved(file(), 1e5)), ref), 0.1);
}

/// A mesh for each triangle.
Scene split(const Scene& scene) {
  Scene out = scene;
  out.meshes.clear();
  for (const Mesh& mesh : scene.meshes) {
    for (const glm::uvec3& t : mesh.triangles) {
      Mesh part = mesh;
      part.object_id = std::uint32_t(out.meshes.size()) + 1;
      part.triangles = {{0, 1, 2}};
      const auto keep = [&t](auto& list) {
        if (!list.empty()) list = {list[t.x], list[t.y], list[t.z]};
      };
      keep(part.positions), keep(part.normals), keep(part.uv[0]), keep(part.uv[1]), keep(part.colors);
      out.meshes.push_back(std::move(part));
    }
  }
  return out;
}

/// One mesh for each material, in which the last mesh comes first.
Scene merged(const Scene& scene) {
  Scene out = scene;
  out.meshes.clear();
  std::map<int, Mesh> of_material;
  for (size_t k = scene.meshes.size(); k-- > 0;) {
    const Mesh& mesh = scene.meshes[k];
    Mesh& all = of_material.try_emplace(mesh.material).first->second;
    const glm::uvec3 first(static_cast<unsigned>(all.positions.size()));
    all.material = mesh.material;
    all.object_id = std::uint32_t(mesh.material) + 1;
    const auto append = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
    append(all.positions, mesh.positions), append(all.normals, mesh.normals), append(all.colors, mesh.colors);
    for (size_t i = 0; i < 2; ++i) append(all.uv[i], mesh.uv[i]);
    for (const glm::uvec3& t : mesh.triangles) all.triangles.push_back(first + t);
  }
  for (auto& [material, mesh] : of_material) out.meshes.push_back(std::move(mesh));
  return out;
}

// How triangles are told apart into meshes is no matter of light. (Instances: SceneSkin.Instances.)
TEST_P(Recipes, SplitAndMerged) {
  if (has_been_tested()) return;
  const Scene scene = load_scene(file());
  const Image ref = picture(scene);
  expect_of_frame("split", fmt::format("{}, {}, a mesh for each triangle", GetParam(), scene.name),
                  rmse_percent(picture(split(scene)), ref), 1e-3);
  expect_of_frame("split", fmt::format("{}, {}, a mesh for each material", GetParam(), scene.name),
                  rmse_percent(picture(merged(scene)), ref), GetParam() == "lattice" ? 1.9 : 1e-3, 1e-3,
                  GetParam() == "lattice" ? "points of imperfect maps go through triangles in their order" : "");
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

INSTANTIATE_TEST_SUITE_P(All, Recipes, testing::ValuesIn(recipe_names()), [](const auto& test) { return test.param; });

}  // namespace
}  // namespace volgi::test
