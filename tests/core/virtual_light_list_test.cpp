#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <functional>
#include <limits>
#include <random>
#include <string>

#include "core/error.h"
#include "core/virtual_light_list.h"
#include "tests/support/gltf_writer.h"

namespace volgi {
namespace {

using test::TemporaryFolder;

shared::VirtualLight some_light() {
  shared::VirtualLight light{};
  light.position = {1.0f, 2.0f, 3.0f};
  light.normal = {0.0f, 1.0f, 0.0f};
  light.flux = {0.5f, 0.25f, 0.125f};
  light.area_m2 = 0.01f;
  return light;
}

std::string error_of(const std::function<void()>& action, ExitCode code) {
  try {
    action();
  } catch (const Error& error) {
    std::string message = error.what();
    EXPECT_EQ(error.code(), code) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    EXPECT_LT(message.size(), 400u) << message;
    return message;
  }
  return "accepted";
}

TEST(VirtualLightList, ReadsBackEveryBit) {
  const TemporaryFolder folder;
  std::mt19937 random(7);
  VirtualLightList list;
  list.world_origin = {1e5 + 1.0 / 3.0, -0.1, 4.9406564584124654e-324};
  const auto any_float = [&] {  // any finite pattern of bits
    for (;;) {
      const auto bits = static_cast<std::uint32_t>(random());
      float value = 0;
      std::memcpy(&value, &bits, sizeof value);
      if (std::isfinite(value)) return value;
    }
  };
  const auto any_vector = [&] { return glm::vec3(any_float(), any_float(), any_float()); };
  for (int i = 0; i < 5000; ++i) {
    shared::VirtualLight light = some_light();
    light.position = any_vector();
    light.flux = glm::abs(any_vector());
    light.area_m2 = std::abs(any_float());
    light.normal = glm::normalize(glm::vec3(std::normal_distribution<float>()(random), 0.3f, -0.7f));
    light.kind = i % 4;
    light.source = light.kind == VIRTUAL_LIGHT_EMITTED ? -1 : i;
    list.lights.push_back(light);
  }
  list.lights[0].position = {-0.0f, std::numeric_limits<float>::denorm_min(), std::numeric_limits<float>::max()};
  list.lights[1].flux = glm::vec3(0.0f);  // met nothing: its normal does not matter
  list.lights[1].normal = glm::vec3(0.0f);
  write_virtual_lights(folder / "lights.json", list);
  const VirtualLightList back = read_virtual_lights(folder / "lights.json");
  EXPECT_EQ(back.world_origin, list.world_origin);
  ASSERT_EQ(back.lights.size(), list.lights.size());
  EXPECT_EQ(std::memcmp(back.lights.data(), list.lights.data(), list.lights.size() * sizeof list.lights[0]), 0);
}

TEST(VirtualLightList, EmptyListIsAList) {
  const TemporaryFolder folder;
  write_virtual_lights(folder / "lights.json", {});
  EXPECT_TRUE(read_virtual_lights(folder / "lights.json").lights.empty());
}

TEST(VirtualLightList, RefusesToWriteWhatItWouldNotRead) {
  const TemporaryFolder folder;
  const auto message = [&](const std::function<void(shared::VirtualLight&)>& spoil) {
    VirtualLightList list{glm::dvec3(0), {some_light(), some_light()}};
    spoil(list.lights[1]);
    const auto file = folder / "lights.json";
    std::string text = error_of([&] { write_virtual_lights(file, list); }, ExitCode::cannot_write);
    EXPECT_FALSE(std::filesystem::exists(file));
    return text;
  };
  EXPECT_NE(message([](auto& l) { l.flux.y = std::nanf(""); }).find("light 1: flux"), std::string::npos);
  EXPECT_NE(message([](auto& l) { l.position.x = INFINITY; }).find("light 1: position"), std::string::npos);
  EXPECT_NE(message([](auto& l) { l.normal *= 2.0f; }).find("light 1: normal"), std::string::npos);
  EXPECT_NE(message([](auto& l) { l.kind = 4; }).find("light 1: kind"), std::string::npos);
  EXPECT_NE(error_of([] { write_virtual_lights("/no such folder/l.json", {}); }, ExitCode::cannot_write)
                .find("no such folder"),
            std::string::npos);
}

class HostileVirtualLights : public ::testing::Test {
 protected:
  void expect_refused(const std::string& text, const std::string& part) {
    const auto file = folder_ / "bad.json";
    std::ofstream(file) << text;
    const std::string message = error_of([&] { read_virtual_lights(file); }, ExitCode::bad_input);
    EXPECT_EQ(message.find(file.string()), 0u) << message;
    EXPECT_NE(message.find(part), std::string::npos) << message << "\n  of " << text.substr(0, 300);
  }
  /// A good light 0, then one whose text `from` became `to`.
  void expect_light_refused(const std::string& from, const std::string& to, const std::string& part) {
    std::string bad = kGood;
    ASSERT_NE(bad.find(from), std::string::npos);
    bad.replace(bad.find(from), from.size(), to);
    expect_refused(kHead + kGood + ", " + bad + "]}", part);
  }

  const std::string kHead = R"({"format": "volgi virtual lights 1", "world_origin": [0, 0, 0], "lights": [)";
  const std::string kGood = R"({"kind": "reflected", "source": 0, "position": [1, 2, 3], "normal": [0, 1, 0], )"
                            R"("flux": [0.5, 0.25, 0], "area_m2": 0.01})";
  TemporaryFolder folder_;
};

TEST_F(HostileVirtualLights, GoodTextIsRead) {
  const auto file = folder_ / "good.json";
  std::ofstream(file) << kHead + kGood + "]}";
  EXPECT_EQ(read_virtual_lights(file).lights.at(0).flux, glm::vec3(0.5f, 0.25f, 0.0f));
}

TEST_F(HostileVirtualLights, FieldsAreNamed) {
  expect_light_refused("\"reflected\"", "\"glowing\\n\"", "light 1: kind: must be \"reflected\"");
  expect_light_refused("\"reflected\"", "1", "light 1: kind: must be a string");
  expect_light_refused("\"source\": 0", "\"source\": -2", "light 1: source");
  expect_light_refused("\"source\": 0", "\"source\": 1.5", "light 1: source: must be a whole number");
  expect_light_refused("\"source\": 0", "\"source\": 99999999999", "light 1: source");
  expect_light_refused("\"source\": 0", "\"source\": 18446744073709551615", "light 1: source");
  expect_light_refused("[1, 2, 3]", "[1, 2]", "light 1: position: must have 3 numbers, it has 2");
  expect_light_refused("[1, 2, 3]", "[1, 2, 3, 4]", "light 1: position: must have 3 numbers, it has 4");
  expect_light_refused("[1, 2, 3]", "[1, null, 3]", "light 1: position: must be a number, not null");
  expect_light_refused("[1, 2, 3]", "[1, [2], 3]", "light 1: position: must be a number, not a list");
  expect_light_refused("[1, 2, 3]", "[1, 1e39, 3]", "light 1: position: 1e+39 is too large for a float");
  expect_light_refused("[1, 2, 3]", "[1, 1e999, 3]", "light 1: position: 1e999 is too large");
  expect_light_refused("[1, 2, 3]", "[1, NaN, 3]", "light 1: position: not JSON");
  expect_light_refused("[1, 2, 3]", "\"here\"", "light 1: position: must be a list of 3 numbers");
  expect_light_refused("[0, 1, 0]", "[0, 1.001, 0]", "light 1: normal must have length 1");
  expect_light_refused("[0, 1, 0]", "[0, 0, 0]", "light 1: normal");
  expect_light_refused("[0.5, 0.25, 0]", "[0.5, -1e-30, 0]", "light 1: flux");
  expect_light_refused("0.01", "-0.01", "light 1: area_m2");
  expect_light_refused("0.01", "true", "light 1: area_m2: must be a number");
  expect_light_refused("0.01", "1e999", "light 1: area_m2: 1e999");
  expect_light_refused("0.01", "0.01, \"flux\": [1, 1, 1]", "light 1: flux: is given twice");
  expect_light_refused("0.01", "0.01, \"colour\": 1", "light 1: unknown field 'colour'");
  for (const std::string field : {"kind", "source", "position", "normal", "flux", "area_m2"}) {
    std::string bad = kGood;
    const size_t start = bad.find('"' + field), next = bad.find(", \"", start);
    bad.erase(start, next == std::string::npos ? bad.size() - 1 - start : next + 2 - start);
    if (next == std::string::npos) bad.erase(bad.rfind(','), 1);
    expect_refused(kHead + bad + "]}", "light 0: " + field + " is missing");
  }
}

TEST_F(HostileVirtualLights, FilesAreNamed) {
  expect_refused("", "not JSON");
  expect_refused("[1, 2]", "not a list of virtual lights");
  expect_refused("7", "not a list of virtual lights");
  expect_refused("{}", "not a list of virtual lights");
  expect_refused(R"({"asset": {"version": "2.0"}})", "not a list of virtual lights");
  expect_refused(R"({"format": "volgi virtual lights 2", "world_origin": [0, 0, 0], "lights": []})", "\"format\" must");
  expect_refused(R"({"format": 1})", "\"format\" must");
  expect_refused(R"({"format": "volgi virtual lights 1", "lights": []})", "world_origin is missing");
  expect_refused(R"({"format": "volgi virtual lights 1", "world_origin": [0, 0, 0]})", "lights is missing");
  expect_refused(R"({"format": "volgi virtual lights 1", "world_origin": [0, 1e999, 0]})", "world_origin: 1e999");
  expect_refused(R"({"format": "volgi virtual lights 1", "world_origin": [0, 1]})", "world_origin: must have 3");
  expect_refused(R"({"format": "volgi virtual lights 1", "world_origin": 1})", "world_origin: must be a list");
  expect_refused(R"({"format": "volgi virtual lights 1", "world_origin": [{}, 0, 0]})", "world_origin: must be");
  expect_refused(R"({"format": "volgi virtual lights 1", "lights": {}})", "lights: must be a list");
  expect_refused(R"({"format": "volgi virtual lights 1", "count": 1e9})", "unknown field 'count'");
  expect_refused(kHead + "[]]}", "light 0: must be an object");
  expect_refused(kHead + kGood + ", 7]}", "light 1: must be an object");
  expect_refused(kHead + kGood, "not JSON");
  expect_refused(kHead + kGood + "]} {}", "not JSON");
  expect_refused(kHead + kGood + "], \"lights\": []}", "lights: is given twice");
  expect_refused(kHead + std::string(100000, '['), "light 0");
  expect_refused(std::string(100000, '{'), "not JSON");
  expect_refused("\x01\x02\xff\n\n", "not JSON");
  const std::string missing = error_of([&] { read_virtual_lights(folder_ / "no.json"); }, ExitCode::bad_input);
  EXPECT_NE(missing.find("no such file"), std::string::npos) << missing;
  const std::string directory = error_of([&] { read_virtual_lights(folder_.path()); }, ExitCode::bad_input);
  EXPECT_NE(directory.find("cannot be read"), std::string::npos) << directory;
}

}  // namespace
}  // namespace volgi
