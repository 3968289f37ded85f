// Skins, morph targets and instances against the same scene posed by hand.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/constants.hpp>

#include "core/error.h"
#include "core/scene.h"
#include "tests/support/gltf_writer.h"

namespace volgi {
namespace {

using test::GltfWriter;
using test::Json;
using test::TemporaryFolder;

class SceneSkin : public ::testing::Test {
 protected:
  Scene load(double time_s = 0.0) {
    return load_scene(writer.save_glb(folder / ("s" + std::to_string(files_++) + ".glb")), time_s);
  }
  static glm::dvec3 corner(const Scene& scene, size_t k, size_t mesh = 0) {
    return scene.world_origin + glm::dvec3(scene.meshes.at(mesh).positions.at(k));
  }
  static void expect_near(glm::dvec3 a, glm::dvec3 b) {
    EXPECT_LT(glm::distance(a, b), 1e-5) << a.x << " " << a.y << " " << a.z << " instead of " << b.x << " " << b.y
                                         << " " << b.z;
  }
  /// A triangle on two joints: corner 0 on the first, 1 on the second, 2 a quarter on the first.
  void skinned() {
    const int p = writer.floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
    const int n = writer.floats({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
    const int j =
        writer.accessor(std::vector<std::uint8_t>{0, 1, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0}, "VEC4", test::type_ubyte);
    const int w = writer.floats({1, 0, 0, 0, 1, 0, 0, 0, 0.25f, 0.75f, 0, 0}, "VEC4");
    const int ibm = writer.accessor(std::vector<float>{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0,  0, 0, 1,  //
                                                       1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -1, 0, 0, 1},
                                    "VEC4", test::type_float);
    writer.root["accessors"][size_t(ibm)]["type"] = "MAT4";
    writer.root["accessors"][size_t(ibm)]["count"] = 2;
    // Its own node, and what is above it, do not count.
    mesh_node = writer.mesh_node({{"attributes", {{"POSITION", p}, {"NORMAL", n}, {"JOINTS_0", j}, {"WEIGHTS_0", w}}}},
                                 {{"skin", 0}, {"scale", {100.0, 100.0, 100.0}}, {"translation", {0.0, 50.0, 0.0}}});
    first_joint = writer.push("nodes", {{"translation", {0.0, 0.0, 2.0}}});
    second_joint = writer.push("nodes", {{"translation", {1.0, 0.0, 0.0}}});
    writer.root["nodes"][size_t(first_joint)]["children"] = {second_joint};
    writer.push("skins", {{"joints", {first_joint, second_joint}}, {"inverseBindMatrices", ibm}});
  }

  TemporaryFolder folder;
  GltfWriter writer;
  int mesh_node = 0, first_joint = 0, second_joint = 0;

 private:
  int files_ = 0;
};

TEST_F(SceneSkin, JointsCarryVerticesAndTheNodeDoesNot) {
  skinned();
  const Scene rest = load();
  expect_near(corner(rest, 0), {0, 0, 2});
  expect_near(corner(rest, 1), {1, 0, 2});
  expect_near(corner(rest, 2), {0, 1, 2});
  // The second joint turned by a quarter about z: its vertices turn about (1, 0, 2).
  const double half = std::sqrt(0.5);
  writer.root["nodes"][size_t(second_joint)]["rotation"] = {0.0, 0.0, half, half};
  const Scene turned = load();
  expect_near(corner(turned, 0), {0, 0, 2});
  expect_near(corner(turned, 1), {1, 0, 2});
  // (0, 1) is (-1, 1) from that joint, turned (-1, -1): at (0, -1, 2); three quarters of that and one of (0, 1, 2).
  expect_near(corner(turned, 2), {0, -0.5, 2});
}

TEST_F(SceneSkin, FollowsItsAnimation) {
  skinned();
  const int times = writer.floats({0, 1}, "SCALAR"), values = writer.floats({0, 0, 2, 0, 0, 6}, "VEC3");
  const Json channel = {{"sampler", 0}, {"target", {{"node", first_joint}, {"path", "translation"}}}};
  writer.push("animations", {{"samplers", {{{"input", times}, {"output", values}}}}, {"channels", {channel}}});
  for (const double t : {0.0, 0.5, 1.0}) expect_near(corner(load(t), 1), {1, 0, 2 + 4 * t});
}

TEST_F(SceneSkin, WeightsAreMadeOneAndMissingMatricesAreUnits) {
  skinned();
  writer.root["skins"][0].erase("inverseBindMatrices");
  const Scene scene = load();
  expect_near(corner(scene, 1), {2, 0, 2});
  expect_near(corner(scene, 2), {0.75, 1, 2});
}

TEST_F(SceneSkin, JointsThatAreNotThereAreRefused) {
  skinned();
  writer.root["skins"][0]["joints"] = {first_joint};
  EXPECT_THROW(load(), Error);
  writer.root["skins"][0]["joints"] = {first_joint, 99};
  EXPECT_THROW(load(), Error);
}

TEST_F(SceneSkin, SharedMeshOfTwoSkins) {
  skinned();
  const int other = writer.push("nodes", {{"translation", {0.0, 0.0, 9.0}}});
  writer.push("skins", {{"joints", {other, other}}});
  writer.push("nodes", {{"mesh", 0}, {"skin", 1}});
  const Scene scene = load();
  ASSERT_EQ(scene.meshes.size(), 2u);
  expect_near(corner(scene, 0, 0), {0, 0, 2});
  expect_near(corner(scene, 0, 1), {0, 0, 9});
}

class SceneMorph : public SceneSkin {
 protected:
  void morphing() {
    const int p = writer.floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
    const int a = writer.floats({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
    // The second target: sparse, without a buffer view; its second vertex moves.
    const int b = writer.push("accessors", {{"componentType", 5126}, {"count", 3}, {"type", "VEC3"}});
    writer.root["accessors"][size_t(b)]["sparse"] = {
        {"count", 1},
        {"indices", {{"bufferView", writer.view(std::vector<std::uint8_t>{1})}, {"componentType", 5121}}},
        {"values", {{"bufferView", writer.view(std::vector<float>{2, 0, 0})}}}};
    writer.mesh_node({{"attributes", {{"POSITION", p}}}, {"targets", {{{"POSITION", a}}, {{"POSITION", b}}}}});
  }
};

TEST_F(SceneMorph, WeightsOfMeshAndNode) {
  morphing();
  expect_near(corner(load(), 1), {1, 0, 0});
  writer.root["meshes"][0]["weights"] = {0.5, 0.25};
  expect_near(corner(load(), 0), {0, 0, 0.5});
  expect_near(corner(load(), 1), {1.5, 0, 0.5});
  writer.root["nodes"][0]["weights"] = {0.0, 1.0};
  expect_near(corner(load(), 1), {3, 0, 0});
}

TEST_F(SceneMorph, Animated) {
  morphing();
  const int times = writer.floats({0, 2}, "SCALAR"), values = writer.floats({0, 0, 1, 0.5f}, "SCALAR");
  const Json channel = {{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}};
  writer.push("animations", {{"samplers", {{{"input", times}, {"output", values}}}}, {"channels", {channel}}});
  expect_near(corner(load(0.0), 1), {1, 0, 0});
  expect_near(corner(load(1.0), 1), {1.5, 0, 0.5});
  expect_near(corner(load(2.0), 1), {2, 0, 1});
}

TEST_F(SceneSkin, Instances) {
  const int p = writer.floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
  const int t = writer.floats({0.7f, 0.7f, 0, -0.7f, 0.7f, 0, 0, 0, 3}, "VEC3");
  const float half = std::sqrt(0.5f);
  const int r = writer.floats({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, half, half}, "VEC4");
  const int s = writer.floats({1, 1, 1, 2, 2, 2, 1, 1, 1}, "VEC3");
  const Json attributes = {{"TRANSLATION", t}, {"ROTATION", r}, {"SCALE", s}};
  writer.mesh_node(
      {{"attributes", {{"POSITION", p}}}},
      {{"translation", {10.0, 0.0, 0.0}}, {"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", attributes}}}}}});
  writer.root["extensionsUsed"] = writer.root["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
  const Scene scene = load();
  ASSERT_EQ(scene.meshes.size(), 3u);
  expect_near(corner(scene, 1, 0), {11.7, 0.7, 0});
  expect_near(corner(scene, 1, 1), {11.3, 0.7, 0});
  expect_near(corner(scene, 1, 2), {10, 1, 3});
  writer.root["accessors"][size_t(s)]["count"] = 2;
  EXPECT_THROW(load(), Error);
}

}  // namespace
}  // namespace volgi
