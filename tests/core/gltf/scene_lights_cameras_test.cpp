#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/constants.hpp>

#include "core/light.h"
#include "core/scene.h"
#include "tests/support/gltf_writer.h"

namespace volgi {
namespace {

using test::GltfWriter;
using test::Json;
using test::TemporaryFolder;

void expect_near(glm::vec3 a, glm::vec3 b, float tolerance = 1e-5f) {
  EXPECT_LT(glm::distance(a, b), tolerance)
      << a.x << " " << a.y << " " << a.z << " instead of " << b.x << " " << b.y << " " << b.z;
}

class SceneLightsCameras : public ::testing::Test {
 protected:
  Scene load() { return load_scene(writer.save_glb(folder / "scene.glb")); }
  void light_node(const Json& light, Json node) {
    auto& lights = writer.root["extensions"]["KHR_lights_punctual"]["lights"];
    node["extensions"]["KHR_lights_punctual"]["light"] = lights.size();
    lights.push_back(light);
    writer.push("nodes", node);
  }
  void camera_node(const Json& camera, Json node) {
    node["camera"] = writer.push("cameras", camera);
    writer.push("nodes", node);
  }

  TemporaryFolder folder;
  GltfWriter writer;
  const double h = std::sqrt(0.5);
};

TEST_F(SceneLightsCameras, LightsFollowTheirNodesAndTheOrigin) {
  writer.triangle({{"translation", {10.0, 0.0, 0.0}}});  // origin (10.5, 0.5, 0)
  light_node({{"type", "point"}, {"intensity", 40.0}, {"color", {1.0, 0.5, 0.25}}, {"range", 7.0}, {"name", "lamp"}},
             {{"translation", {1.0, 2.0, 3.0}}, {"scale", {5.0, 5.0, 5.0}}});
  // A quarter turn about X carries -Z to +Y.
  light_node({{"type", "spot"}, {"spot", {{"innerConeAngle", 0.2}, {"outerConeAngle", 0.5}}}},
             {{"rotation", {h, 0.0, 0.0, h}}, {"name", "spot node"}});
  light_node({{"type", "directional"}, {"intensity", 3.0}}, Json::object());
  const Scene scene = load();
  ASSERT_EQ(scene.lights.size(), 3u);
  EXPECT_EQ(scene.lights[0].type, Light::Type::point);
  EXPECT_EQ(scene.lights[0].name, "lamp");
  expect_near(scene.lights[0].position, {-9.5f, 1.5f, 3});
  expect_near(scene.lights[0].intensity, {40, 20, 10});
  EXPECT_EQ(scene.lights[0].range_m, 7.0f);
  EXPECT_EQ(scene.lights[1].type, Light::Type::spot);
  EXPECT_EQ(scene.lights[1].name, "spot node");
  expect_near(scene.lights[1].direction, {0, 1, 0});
  EXPECT_FLOAT_EQ(scene.lights[1].inner_cone_rad, 0.2f);
  EXPECT_FLOAT_EQ(scene.lights[1].outer_cone_rad, 0.5f);
  expect_near(scene.lights[1].intensity, glm::vec3(1));
  EXPECT_EQ(scene.lights[2].type, Light::Type::directional);
  expect_near(scene.lights[2].direction, {0, 0, -1});
}

TEST_F(SceneLightsCameras, SpotDefaultsAreTheExtensions) {
  light_node({{"type", "spot"}, {"spot", Json::object()}}, Json::object());
  const Light light = load().lights[0];
  EXPECT_EQ(light.inner_cone_rad, 0.0f);
  EXPECT_FLOAT_EQ(light.outer_cone_rad, glm::quarter_pi<float>());
  EXPECT_EQ(light.range_m, 0.0f);
}

TEST_F(SceneLightsCameras, SharedLightHasTheFalloffOfTheExtension) {
  Light light;
  light.type = Light::Type::spot;
  light.intensity = {100, 200, 300};
  light.inner_cone_rad = 0.3f;
  light.outer_cone_rad = 0.6f;
  light.range_m = 20.0f;
  const shared::PunctualLight spot = to_shared(light);
  const auto along = [&](float angle) { return shared::spot_falloff(spot, {std::sin(angle), 0, -std::cos(angle)}); };
  EXPECT_FLOAT_EQ(along(0.0f), 1.0f);
  EXPECT_NEAR(along(0.299f), 1.0f, 1e-2f);
  EXPECT_NEAR(along(0.601f), 0.0f, 1e-4f);
  const float middle = (std::cos(0.45f) - std::cos(0.6f)) / (std::cos(0.3f) - std::cos(0.6f));
  EXPECT_NEAR(along(0.45f), middle * middle, 1e-5f);
  glm::vec3 to_light;
  const glm::vec3 e = shared::perpendicular_irradiance(spot, {0, 0, -10}, to_light);
  expect_near(e, glm::vec3(1, 2, 3) * (1.0f - 1.0f / 16.0f));
  expect_near(to_light, {0, 0, 1});
  light.type = Light::Type::directional;
  expect_near(shared::perpendicular_irradiance(to_shared(light), {5, 5, -1000}, to_light), light.intensity);
}

TEST_F(SceneLightsCameras, CamerasFollowTheirNodes) {
  writer.triangle();
  camera_node(
      {{"type", "perspective"}, {"perspective", {{"yfov", 0.8}, {"znear", 0.1}, {"zfar", 50.0}, {"aspectRatio", 2.0}}}},
      {{"translation", {0.5, 0.5, 4.0}}, {"rotation", {0.0, h, 0.0, h}}, {"name", "eye"}});
  camera_node(
      {{"type", "orthographic"}, {"orthographic", {{"xmag", 3.0}, {"ymag", 2.0}, {"znear", 0.0}, {"zfar", 9.0}}}},
      Json::object());
  const Scene scene = load();
  ASSERT_EQ(scene.cameras.size(), 2u);
  EXPECT_EQ(scene.cameras[0].name, "eye");
  EXPECT_EQ(scene.cameras[0].kind, Camera::Kind::perspective);
  EXPECT_FLOAT_EQ(scene.cameras[0].yfov_rad, 0.8f);
  EXPECT_FLOAT_EQ(scene.cameras[0].znear, 0.1f);
  EXPECT_FLOAT_EQ(scene.cameras[0].zfar, 50.0f);
  expect_near(scene.cameras[0].world_from_camera[3], {0, 0, 4});
  // A quarter turn about Y carries -Z to -X.
  expect_near(camera_ray(scene.cameras[0], {8, 8}, {16, 16}).direction, {-1, 0, 0});
  EXPECT_EQ(scene.cameras[1].kind, Camera::Kind::orthographic);
  EXPECT_FLOAT_EQ(scene.cameras[1].ymag, 2.0f);
  EXPECT_FLOAT_EQ(scene.cameras[1].zfar, 9.0f);
}

TEST_F(SceneLightsCameras, InfiniteFarPlaneReachesBeyondTheScene) {
  writer.triangle({{"scale", {100.0, 100.0, 100.0}}});
  camera_node({{"type", "perspective"}, {"perspective", {{"yfov", 0.8}, {"znear", 0.1}}}},
              {{"translation", {50.0, 50.0, 300.0}}});
  const Camera camera = load().cameras[0];
  EXPECT_GT(camera.zfar, std::sqrt(300.0f * 300.0f + 2 * 50.0f * 50.0f));
  EXPECT_LT(camera.zfar, 400.0f);
}

/// glTF 2.0, 3.10.2: the view ignores its node's scale, even or not.
TEST_F(SceneLightsCameras, TheScaleOfACamerasNodeIsIgnored) {
  const Json perspective = {{"type", "perspective"}, {"perspective", {{"yfov", 0.8}, {"znear", 0.1}, {"zfar", 50.0}}}};
  const Json orthographic = {{"type", "orthographic"},
                             {"orthographic", {{"xmag", 3.0}, {"ymag", 2.0}, {"znear", 0.5}, {"zfar", 9.0}}}};
  const Json turned = {{"rotation", {0.0, 0.6, 0.0, 0.8}}, {"translation", {1.0, 2.0, 3.0}}};
  for (const Json& camera : {perspective, orthographic}) {
    writer = GltfWriter();
    camera_node(camera, turned);
    const Camera plain = load().cameras[0];
    for (const std::vector<double>& scale :
         {std::vector<double>{0.01, 0.01, 0.01}, {1.0, 2.0, 1.0}, {10.0, 10.0, 10.0}}) {
      writer = GltfWriter();
      Json node = turned;
      node["scale"] = scale;
      camera_node(camera, node);
      const Camera scaled = load().cameras[0];
      for (int column = 0; column < 4; ++column)
        expect_near(glm::vec3(scaled.world_from_camera[column]), glm::vec3(plain.world_from_camera[column]));
      EXPECT_EQ(scaled.yfov_rad, plain.yfov_rad);
      EXPECT_EQ(scaled.ymag, plain.ymag);
      EXPECT_EQ(scaled.znear, plain.znear);
      EXPECT_EQ(scaled.zfar, plain.zfar);
    }
  }
}

}  // namespace
}  // namespace volgi
