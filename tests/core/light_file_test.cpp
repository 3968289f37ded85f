#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "core/error.h"
#include "core/light_file.h"
#include "tests/support/gltf_writer.h"

namespace volgi {
namespace {

using test::TemporaryFolder;

Light some_spot() {
  Light light;
  light.name = "a \"lamp\"";
  light.type = Light::Type::spot;
  light.position = {0.25f, -1.5f, 3.0f};
  light.direction = glm::normalize(glm::vec3(1.0f, -2.0f, 0.5f));
  light.intensity = {10.5f, 0.0f, 3.25f};
  light.inner_cone_rad = 0.3f;
  light.outer_cone_rad = 0.6f;
  light.range_m = 7.0f;
  return light;
}

TEST(LightFile, ComesBackTheSame) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "lights.json";
  const glm::dvec3 origin(1e5, 2.0, -3.0);
  Light sun;
  sun.type = Light::Type::directional;
  sun.intensity = glm::vec3(2.0f);
  write_light_file(path, {{some_spot(), sun}, {{2, {1.0f, 0.5f, 0.25f}}}}, origin);
  const LightFile read = read_light_file(path, origin);
  ASSERT_EQ(read.lights.size(), 2u);
  const Light spot = some_spot();
  EXPECT_EQ(read.lights[0].name, spot.name);
  EXPECT_EQ(read.lights[0].type, spot.type);
  EXPECT_LT(glm::distance(read.lights[0].position, spot.position), 1e-6f);
  EXPECT_LT(glm::distance(read.lights[0].direction, spot.direction), 1e-6f);
  EXPECT_EQ(read.lights[0].intensity, spot.intensity);
  EXPECT_EQ(read.lights[0].inner_cone_rad, spot.inner_cone_rad);
  EXPECT_EQ(read.lights[0].outer_cone_rad, spot.outer_cone_rad);
  EXPECT_EQ(read.lights[0].range_m, spot.range_m);
  EXPECT_EQ(read.lights[1].type, Light::Type::directional);
  EXPECT_EQ(read.emissive_radiance.at(2), glm::vec3(1.0f, 0.5f, 0.25f));
}

TEST(LightFile, TakesThePlaceOfTheScenesLights) {
  Scene scene;
  scene.materials.resize(2);
  scene.lights.resize(3);
  const LightFile light{{some_spot()}, {{1, glm::vec3(4.0f)}}};
  for (int k = 0; k < 2; ++k) apply_light_file(light, "lights.json", scene);  // for each frame of an animation
  ASSERT_EQ(scene.lights.size(), 1u);
  EXPECT_EQ(scene.materials[1].emissive_radiance, glm::vec3(4.0f));
  EXPECT_THROW(apply_light_file({{}, {{2, glm::vec3(1.0f)}}}, "lights.json", scene), Error);
}

TEST(LightFile, RefusesByName) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "lights.json";
  const std::string light = R"({"name":"a","type":"point","position":[0,0,0],"direction":[0,0,-1],"intensity":[1,1,1],)"
                            R"("inner_cone_rad":0,"outer_cone_rad":1,"range_m":0})";
  const auto message_of = [&](const std::string& text) -> std::string {
    std::ofstream(path) << text;
    try {
      read_light_file(path, glm::dvec3(0.0));
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::bad_input);
      return error.what();
    }
    return "accepted";
  };
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string changed = light;
    changed.replace(changed.find(from), from.size(), to);
    return message_of(R"({"volgi_lights":1,"lights":[)" + light + "," + changed + "]}");
  };
  EXPECT_EQ(with("[1,1,1]", "[1,1,1]"), "accepted");
  EXPECT_NE(with("[1,1,1]", "[1,-1,1]").find("light 1: intensity"), std::string::npos);
  EXPECT_NE(with("[1,1,1]", "[1,1]").find("light 1: intensity"), std::string::npos);
  EXPECT_NE(with("\"point\"", "\"lantern\"").find("light 1: type"), std::string::npos);
  EXPECT_NE(with("[0,0,-1]", "[0,0,0]").find("direction"), std::string::npos);
  EXPECT_NE(with("\"range_m\":0", "\"range_m\":\"far\"").find("range_m"), std::string::npos);
  EXPECT_NE(with("\"name\":\"a\",", "").find("name is missing"), std::string::npos);
  for (const char* text :
       {"", "[]", "{", R"({"volgi_lights":2})", R"({"volgi_lights":"1"})", R"({"volgi_lights":1,"lights":3})"})
    EXPECT_NE(message_of(text), "accepted") << text;
  EXPECT_THROW(read_light_file(folder.path() / "none.json", glm::dvec3(0.0)), Error);
}

}  // namespace
}  // namespace volgi
