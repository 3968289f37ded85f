#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/constants.hpp>

#include "core/scene.h"
#include "tests/support/gltf_writer.h"

namespace volgi {
namespace {

using test::GltfWriter;
using test::Json;
using test::TemporaryFolder;

/// One animated node that carries a triangle with corners (0,0,0) (1,0,0) (0,1,0).
class SceneAnimation : public ::testing::Test {
 protected:
  void animate(const std::string& path, const std::string& interpolation, const std::vector<float>& times,
               const std::vector<float>& values, const std::string& type = "VEC3") {
    const int sampler_output = writer.floats(values, type);
    Json sampler = {{"input", writer.floats(times, "SCALAR")}, {"output", sampler_output}};
    if (!interpolation.empty()) sampler["interpolation"] = interpolation;
    const Json channel = {{"sampler", 0}, {"target", {{"node", node}, {"path", path}}}};
    writer.push("animations", {{"samplers", Json::array({sampler})}, {"channels", Json::array({channel})}});
  }
  /// File's world position of corner `k` at a time.
  glm::dvec3 corner(double time_s, int k) {
    if (!file) file.emplace(writer.save_glb(folder / "scene.glb"));
    const Scene scene = file->at(time_s);
    return glm::dvec3(scene.meshes[0].positions[size_t(k)]) + scene.world_origin;
  }
  void expect_corner(double time_s, int k, glm::dvec3 expected) {
    const glm::dvec3 p = corner(time_s, k);
    EXPECT_LT(glm::distance(p, expected), 1e-5) << "at " << time_s << ": " << p.x << " " << p.y << " " << p.z;
  }

  TemporaryFolder folder;
  GltfWriter writer;
  int node = writer.triangle({{"translation", {0.0, 0.0, 9.0}}});
  std::optional<SceneFile> file;
};

TEST_F(SceneAnimation, LinearTranslationClampsAtItsEnds) {
  animate("translation", "", {1, 2, 4}, {0, 0, 0, 10, 0, 0, 10, 20, 0});
  expect_corner(-5, 0, {0, 0, 0});
  expect_corner(1, 0, {0, 0, 0});
  expect_corner(1.25, 0, {2.5, 0, 0});
  expect_corner(2, 0, {10, 0, 0});
  expect_corner(3, 0, {10, 10, 0});
  expect_corner(99, 0, {10, 20, 0});
  EXPECT_TRUE(file->animated());
}

TEST_F(SceneAnimation, StepHoldsUntilTheNextKey) {
  animate("translation", "STEP", {0, 1, 2}, {1, 0, 0, 2, 0, 0, 3, 0, 0});
  expect_corner(0.999, 0, {1, 0, 0});
  expect_corner(1, 0, {2, 0, 0});
  expect_corner(1.5, 0, {2, 0, 0});
  expect_corner(2, 0, {3, 0, 0});
}

TEST_F(SceneAnimation, CubicSplineIsHermite) {
  // Keys (in-tangent, value, out-tangent) at 0 and 2 s.
  animate("translation", "CUBICSPLINE", {0, 2}, {0, 0, 0, 1, 0, 0, 3, 0, 0, -1, 0, 0, 5, 0, 0, 0, 0, 0});
  const auto hermite = [](double t) {
    return (2 * t * t * t - 3 * t * t + 1) * 1 + 2 * (t * t * t - 2 * t * t + t) * 3 + (3 * t * t - 2 * t * t * t) * 5 +
           2 * (t * t * t - t * t) * -1;
  };
  for (const double t : {0.0, 0.3, 0.5, 0.8, 1.0}) expect_corner(2 * t, 0, {hermite(t), 0, 0});
  expect_corner(-1, 0, {1, 0, 0});
  expect_corner(3, 0, {5, 0, 0});
}

TEST_F(SceneAnimation, RotationIsSlerpAlongTheShorterWay) {
  const float h = std::sqrt(0.5f);
  // From none to a quarter turn about Z, written with the sign flipped.
  animate("rotation", "LINEAR", {0, 1}, {0, 0, 0, 1, 0, 0, -h, -h}, "VEC4");
  for (const double t : {0.0, 0.25, 0.5, 1.0}) {
    const double angle = t * glm::half_pi<double>();
    expect_corner(t, 1, {std::cos(angle), std::sin(angle), 9});
  }
}

TEST_F(SceneAnimation, NormalizedIntegerRotations) {
  const int out = writer.accessor(std::vector<std::int16_t>{0, 0, 23170, 23170}, "VEC4", test::type_short, true);
  const Json sampler = {{"input", writer.floats({0}, "SCALAR")}, {"output", out}};
  writer.push("animations",
              {{"samplers", Json::array({sampler})},
               {"channels", Json::array({{{"sampler", 0}, {"target", {{"node", node}, {"path", "rotation"}}}}})}});
  expect_corner(0, 1, {0, 1, 9});
}

TEST_F(SceneAnimation, AllAnimationsPlayAndWeightsAreIgnored) {
  animate("scale", "LINEAR", {0, 1}, {1, 1, 1, 3, 3, 3});
  animate("translation", "LINEAR", {0, 1}, {0, 0, 0, 0, 0, 4});
  animate("weights", "LINEAR", {0, 1}, {0, 1}, "SCALAR");
  expect_corner(0.5, 1, {2, 0, 2});
}

TEST_F(SceneAnimation, ParentsMoveChildrenLightsAndCameras) {
  writer.root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
  writer.root["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.7}, {"znear", 0.1}}}}};
  const int child = writer.push(
      "nodes",
      {{"camera", 0}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}, {"translation", {0.0, 0.0, 1.0}}});
  writer.root["nodes"][size_t(node)]["children"] = {child};
  animate("translation", "LINEAR", {0, 1}, {0, 0, 0, 8, 0, 0});
  const Scene scene = SceneFile(writer.save_glb(folder / "a.glb")).at(0.5);
  // The triangle's centre is 0.5, 0.5 from the node.
  EXPECT_EQ(scene.lights[0].position, glm::vec3(-0.5f, -0.5f, 1.0f));
  EXPECT_EQ(glm::vec3(scene.cameras[0].world_from_camera[3]), glm::vec3(-0.5f, -0.5f, 1.0f));
  EXPECT_EQ(scene.world_origin, glm::dvec3(4.5, 0.5, 0));
}

TEST_F(SceneAnimation, RestPoseWithoutAnimations) {
  expect_corner(3, 0, {0, 0, 9});
  EXPECT_FALSE(file->animated());
}

}  // namespace
}  // namespace volgi
