// What the specification allows, and faults that can be repaired: the picture with a warning; refused when strict.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <filesystem>

#include "core/error.h"
#include "core/scene.h"
#include "core/surface.h"
#include "tests/support/gltf_writer.h"

namespace volgi {
namespace {

using test::GltfWriter;
using test::Json;
using test::TemporaryFolder;

class SceneTolerance : public ::testing::Test {
 protected:
  std::filesystem::path save() { return writer.save_glb(folder / fresh_name(".glb")); }
  /// Another one every time: a file is warned about once.
  std::string fresh_name(const std::string& ending) { return "scene" + std::to_string(files_++) + ending; }

  /// The file loads with a warning that contains TEXT, and is refused for the same reason when strict.
  Scene repaired(const std::string& text) { return repaired(save(), text); }
  static Scene repaired(const std::filesystem::path& file, const std::string& text) {
    ::testing::internal::CaptureStderr();
    const Scene scene = load_scene(file);
    const std::string warning = ::testing::internal::GetCapturedStderr();
    EXPECT_NE(warning.find(text), std::string::npos) << warning;
    refused(file, text, {.scene = {}, .animation = {}, .root = {}, .strict = true});
    return scene;
  }
  static void refused(const std::filesystem::path& file, const std::string& text, const SceneReading& reading = {},
                      ExitCode code = ExitCode::bad_input) {
    try {
      load_scene(file, 0.0, reading);
      ADD_FAILURE() << "not refused: " << text;
    } catch (const Error& e) {
      EXPECT_EQ(e.code(), code);
      EXPECT_NE(std::string(e.what()).find(text), std::string::npos) << e.what();
    }
  }
  /// Without a word.
  static Scene silent(const std::filesystem::path& file, const SceneReading& reading = {}) {
    ::testing::internal::CaptureStderr();
    Scene scene = load_scene(file, 0.0, reading);
    const std::string said = ::testing::internal::GetCapturedStderr();
    std::string left;  // but for the default material, which is a metal
    for (size_t at = 0; at < said.size(); at = said.find('\n', at) + 1) {
      const std::string line = said.substr(at, said.find('\n', at) - at);
      if (line.find("metal") == std::string::npos) left += line;
    }
    EXPECT_EQ(left, "");
    return scene;
  }
  int texture(const Json& image) { return writer.push("textures", {{"source", writer.push("images", image)}}); }
  /// One triangle whose corners have the texture coordinates of the texels' middles of a 2 x 2 picture.
  void textured_triangle(const std::string& set = "TEXCOORD_0") {
    const int p = writer.floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
    const int uv = writer.floats({0.25f, 0.25f, 0.75f, 0.25f, 0.25f, 0.75f}, "VEC2");
    writer.mesh_node({{"material", 0}, {"attributes", {{"POSITION", p}, {set, uv}}}});
  }
  Json& paint(const Json& use) {
    writer.push("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", use}, {"metallicFactor", 0.0}}}});
    Json& m = writer.root["materials"].back();
    m["extensions"]["KHR_materials_specular"]["specularFactor"] = 0;
    return m;
  }
  static glm::vec3 albedo(const Scene& scene, int corner) {
    return surface_point(scene, scene.meshes.at(0), 0, corner == 1 ? 1.0f : 0.0f, corner == 2 ? 1.0f : 0.0f).albedo;
  }
  static std::string picture() {  // red, green / blue, white
    return test::png(2, 2, {255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 255, 255, 255, 255});
  }

  TemporaryFolder folder;
  GltfWriter writer;

 private:
  int files_ = 0;
};

TEST_F(SceneTolerance, WholeNumbersWrittenOtherwise) {
  writer.triangle();
  writer.root["accessors"][0]["count"] = 3.0;
  std::string text = writer.finished("data:application/octet-stream;base64," + test::base64(writer.bin)).dump();
  const size_t at = text.find("\"byteLength\":36");
  ASSERT_NE(at, std::string::npos);
  for (const char* length : {"36.0", "3.6e1", "36"}) {
    std::string written = text;
    written.replace(at, 15, std::string("\"byteLength\":") + length);
    const auto file = folder / fresh_name(".gltf");
    test::write_bytes(file, written);
    EXPECT_EQ(silent(file).triangle_count(), 1u) << length;
  }
  std::string wrong = text;
  wrong.replace(at, 15, "\"byteLength\":36.5");
  test::write_bytes(folder / "wrong.gltf", wrong);
  refused(folder / "wrong.gltf", "byteLength must be a whole number");
}

TEST_F(SceneTolerance, DataUrisOfAnyMediaType) {
  writer.triangle();
  for (const char* type : {"data:;base64,", "data:application/octet-stream;charset=utf-8;base64,", "data:x/y;base64,",
                           "data:application/gltf-buffer;base64,"}) {
    const auto file = folder / fresh_name(".gltf");
    test::write_bytes(file, writer.finished(type + test::base64(writer.bin)).dump());
    EXPECT_EQ(silent(file).triangle_count(), 1u) << type;
  }
  std::string escaped = "data:,";
  for (const char c : writer.bin) {
    constexpr const char* digits = "0123456789abcdef";
    escaped += std::string("%") + digits[std::uint8_t(c) >> 4] + digits[std::uint8_t(c) & 15];
  }
  test::write_bytes(folder / "escaped.gltf", writer.finished(escaped).dump());
  EXPECT_EQ(silent(folder / "escaped.gltf").triangle_count(), 1u);
}

TEST_F(SceneTolerance, ImagesInDataUrisOfAnyMediaType) {
  paint({{"index", texture({{"uri", "data:image/jpg;base64," + test::base64(picture())}})}});
  textured_triangle();
  EXPECT_EQ(albedo(silent(save()), 1), glm::vec3(0, 1, 0));
}

TEST_F(SceneTolerance, NamesOfFiles) {
  for (const auto& [name, uri] : {std::pair<std::string, std::string>("a b+c.png", "a%20b+c.png"),
                                  {"a b.png", "a b.png"},
                                  {"big%ball.png", "big%ball.png"},
                                  {"big%ball2.png", "big%25ball2.png"},
                                  {"100%25.png", "100%25.png"},
                                  {"h\xc3\xb6he.png", "h%C3%B6he.png"},
                                  {"h\xc3\xb6he2.png", "h\xc3\xb6he2.png"}}) {
    writer = GltfWriter();
    test::write_bytes(folder / name, picture());
    paint({{"index", texture({{"uri", uri}})}});
    textured_triangle();
    EXPECT_EQ(albedo(silent(save()), 1), glm::vec3(0, 1, 0)) << uri;
  }
}

TEST_F(SceneTolerance, BuffersMayBeLonger) {
  writer.triangle();
  const auto file = writer.save_gltf(folder / "long.gltf", "long.bin");
  test::write_bytes(folder / "long.bin", writer.bin + "more");
  EXPECT_EQ(silent(file).triangle_count(), 1u);
  test::write_bytes(folder / "long.bin", writer.bin.substr(0, writer.bin.size() - 1));
  refused(file, "35 bytes instead of 36");
}

TEST_F(SceneTolerance, RootFolder) {
  std::filesystem::create_directory(folder / "models");
  std::filesystem::create_directory(folder / "shared");
  test::write_bytes(folder / "shared/tex.png", picture());
  paint({{"index", texture({{"uri", "../shared/tex.png"}})}});
  textured_triangle();
  const auto file = writer.save_glb(folder / "models/scene.glb");
  refused(file, "--root");
  EXPECT_EQ(albedo(silent(file, {.scene = {}, .animation = {}, .root = folder.path()}), 1), glm::vec3(0, 1, 0));
  refused(file, "leads out", {.scene = {}, .animation = {}, .root = folder / "models"});
  refused(file, "there is no such folder", {.scene = {}, .animation = {}, .root = folder / "nowhere"});
}

TEST_F(SceneTolerance, MissingImages) {
  Json& m = paint({{"index", texture({{"uri", "nowhere.png"}})}});
  m["normalTexture"]["index"] = 0;
  textured_triangle();
  EXPECT_EQ(albedo(repaired("missing file 'nowhere.png'"), 1), glm::vec3(1.0f));
  writer.root["materials"][0].erase("normalTexture");
  writer.root["materials"][0]["pbrMetallicRoughness"].erase("baseColorTexture");
  silent(save());  // nobody uses it
}

TEST_F(SceneTolerance, TexturesWithoutAnImage) {
  paint({{"index", writer.push("textures", Json::object())}});
  textured_triangle();
  EXPECT_EQ(albedo(repaired("texture 0: no image"), 1), glm::vec3(1.0f));
  writer.root["textures"][0]["extensions"]["KHR_texture_basisu"]["source"] = 0;
  EXPECT_EQ(albedo(repaired("KTX2"), 1), glm::vec3(1.0f));
  // The picture that others can read, where there is one.
  const std::string png = picture();
  const int view = writer.view(std::vector<char>(png.begin(), png.end()));
  writer.root["textures"][0]["source"] = writer.push("images", {{"bufferView", view}, {"mimeType", "image/png"}});
  EXPECT_EQ(albedo(load_scene(save()), 1), glm::vec3(0, 1, 0));
  writer.root["extensionsRequired"] = {"KHR_texture_basisu"};
  refused(save(), "KTX2");
}

TEST_F(SceneTolerance, AnySetOfTextureCoordinates) {
  const std::string png = picture();
  const int view = writer.view(std::vector<char>(png.begin(), png.end()));
  paint({{"index", texture({{"bufferView", view}, {"mimeType", "image/png"}})}, {"texCoord", 2}});
  textured_triangle("TEXCOORD_2");
  const Scene scene = silent(save());
  EXPECT_EQ(albedo(scene, 0), glm::vec3(1, 0, 0));
  EXPECT_EQ(albedo(scene, 1), glm::vec3(0, 1, 0));
  EXPECT_EQ(albedo(scene, 2), glm::vec3(0, 0, 1));
}

TEST_F(SceneTolerance, NoNumbersInTextureCoordinates) {
  const int p = writer.floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
  const int uv = writer.floats({0, 0, NAN, 0, 0, 1}, "VEC2");
  writer.mesh_node({{"attributes", {{"POSITION", p}, {"TEXCOORD_0", uv}}}});
  EXPECT_EQ(repaired("TEXCOORD_0").triangle_count(), 1u);
  writer = GltfWriter();
  const int bad = writer.floats({0, 0, 0, 1, 0, 0, 0, NAN, 0}, "VEC3");
  writer.mesh_node({{"attributes", {{"POSITION", bad}}}});
  refused(save(), "POSITION");
}

TEST_F(SceneTolerance, ScenesThatListChildren) {
  writer.triangle({{"translation", {0.0, 0.0, 2.0}}});
  const int parent = writer.push("nodes", {{"children", {0}}, {"translation", {5.0, 0.0, 0.0}}});
  writer.push("scenes", {{"nodes", {0}}});
  writer.root["scene"] = 0;
  const Scene child = repaired("which is no root or is listed twice");
  ASSERT_EQ(child.triangle_count(), 1u);  // where its parent puts it
  EXPECT_LT(glm::distance(child.world_origin + glm::dvec3(child.meshes[0].positions[0]), {5.0, 0.0, 2.0}), 1e-5);
  writer.root["scenes"][0]["nodes"] = {0, parent, parent};
  EXPECT_EQ(repaired("listed twice").triangle_count(), 1u);
}

TEST_F(SceneTolerance, OtherScenes) {
  writer.triangle();
  writer.triangle({{"translation", {0.0, 0.0, 7.0}}});
  writer.push("scenes", {{"nodes", {0}}});
  writer.push("scenes", {{"nodes", {1}}});
  const auto file = save();
  EXPECT_EQ(load_scene(file).world_origin.z, 0.0);
  EXPECT_EQ(load_scene(file, 0.0, {.scene = 1, .animation = {}, .root = {}}).world_origin.z, 7.0);
  refused(file, "--scene 2", {.scene = 2, .animation = {}, .root = {}}, ExitCode::usage);
}

TEST_F(SceneTolerance, MatricesOfRoundedRows) {
  for (const double w : {0.99999994, 1.0 + 1e-6}) {
    writer = GltfWriter();
    writer.triangle({{"matrix", {1, 0, 0, 1e-17, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 4, w}}});
    EXPECT_EQ(silent(save()).world_origin.z, 4.0);
  }
  writer = GltfWriter();
  writer.triangle({{"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 4, 0.9}}});
  refused(save(), "last row");
}

TEST_F(SceneTolerance, SpotsWhoseInnerConeIsLarger) {
  writer.triangle();
  writer.root["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "spot"}, {"spot", {{"innerConeAngle", 0.4000001}, {"outerConeAngle", 0.4}}}}};
  writer.push("nodes", {{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  const Scene scene = repaired("inner cone angle");
  EXPECT_EQ(scene.lights.at(0).inner_cone_rad, scene.lights.at(0).outer_cone_rad);
}

TEST_F(SceneTolerance, AnimationsThatCannotPlay) {
  writer.triangle();
  const int times = writer.floats({0, 1, 1, 2}, "SCALAR");
  const int values = writer.floats({0, 0, 0, 1, 0, 0, 2, 0, 0, 3, 0, 0}, "VEC3");
  const Json target = {{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}};
  writer.push("animations", {{"samplers", {{{"input", times}, {"output", values}}}}, {"channels", {target}}});
  EXPECT_EQ(repaired("key times do not increase; it is ignored").triangle_count(), 1u);
}

TEST_F(SceneTolerance, ChoosingAnAnimation) {
  writer.triangle();
  const auto clip = [&](const std::string& name, float to) {
    const int times = writer.floats({0, 1}, "SCALAR"), values = writer.floats({0, 0, 0, 0, 0, to}, "VEC3");
    const Json target = {{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}};
    writer.push("animations",
                {{"name", name}, {"samplers", {{{"input", times}, {"output", values}}}}, {"channels", {target}}});
  };
  clip("walk", 3.0f);
  clip("run", 5.0f);
  const auto file = save();
  const auto end = [&](const std::string& animation) {
    return load_scene(file, 1.0, {.scene = {}, .animation = animation, .root = {}}).world_origin.z;
  };
  ::testing::internal::CaptureStderr();
  EXPECT_EQ(end(""), 3.0);  // both move the same node: the first
  EXPECT_NE(::testing::internal::GetCapturedStderr().find("'run'"), std::string::npos);
  EXPECT_EQ(end("run"), 5.0);
  EXPECT_EQ(end("1"), 5.0);
  EXPECT_EQ(end("0"), 3.0);
  EXPECT_EQ(end("all"), 5.0);
  refused(file, "0 'walk', 1 'run'", {.scene = {}, .animation = "swim", .root = {}}, ExitCode::usage);
}

TEST_F(SceneTolerance, OldFilesAreToldTheWayOut) {
  writer.triangle();
  writer.root["asset"]["version"] = "1.0";
  refused(save(), "glTF version 1.0 is not supported, only 2.0 is; Blender");
}

TEST_F(SceneTolerance, FactorsOutsideTheirRange) {
  writer.push("materials",
              {{"pbrMetallicRoughness",
                {{"baseColorFactor", {1.0000001, 0.5, -1e-9}}, {"metallicFactor", 1.2}, {"roughnessFactor", -0.1}}},
               {"alphaMode", "blend"},
               {"extensions", {{"KHR_materials_ior", {{"ior", 0.9}}}}}});
  textured_triangle();
  for (const char* fault : {"has three numbers", "baseColorFactor is", "metallicFactor is 1.2",
                            "roughnessFactor is -0.1", "ior is 0.9", "'blend' counts as BLEND"}) {
    SCOPED_TRACE(fault);
    ::testing::internal::CaptureStderr();
    const Scene scene = load_scene(save());
    EXPECT_NE(::testing::internal::GetCapturedStderr().find(fault), std::string::npos);
    const Material& m = scene.materials[0];
    EXPECT_EQ(m.base_color_factor, glm::vec4(1.0f, 0.5f, 0.0f, 1.0f));
    EXPECT_EQ(m.metallic_factor, 1.0f);
    EXPECT_EQ(m.roughness_factor, 0.0f);
    EXPECT_EQ(m.ior, 1.0f);
    EXPECT_EQ(m.alpha_mode, AlphaMode::blend);
  }
  refused(save(), "baseColorFactor", {.scene = {}, .animation = {}, .root = {}, .strict = true});
  writer.root["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = {1, 1};
  refused(save(), "must have four numbers");
}

// Two layers of one place: where the upper one is a hole, the lower one shows; whichever comes first in the file.
TEST_F(SceneTolerance, LayersOfOtherMaterials) {
  for (const bool hole_first : {true, false}) {
    writer = GltfWriter();
    const int p = writer.floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
    for (const bool hole : {hole_first, !hole_first})
      writer.push("materials", {{"alphaMode", hole ? "MASK" : "OPAQUE"}});
    Json primitives = Json::array();
    for (const int m : {0, 1, 1}) primitives.push_back({{"material", m}, {"attributes", {{"POSITION", p}}}});
    writer.push("nodes", {{"mesh", writer.push("meshes", {{"primitives", primitives}})}});
    ::testing::internal::CaptureStderr();
    const Scene scene = load_scene(save());
    EXPECT_NE(::testing::internal::GetCapturedStderr().find("1 triangles lie exactly on others"), std::string::npos);
    ASSERT_EQ(scene.meshes.size(), 2u);
    const auto height = [&](bool hole) {
      const Mesh& mesh = scene.meshes[hole == hole_first ? 0 : 1];
      return mesh.positions[mesh.triangles[0].x].z;
    };
    EXPECT_NEAR(height(true) - height(false), 2e-5f * std::sqrt(2.0f), 1e-6f);
  }
}

TEST_F(SceneTolerance, DataUrisAsBrowsersReadThem) {
  writer.triangle();
  std::string escaped, broken;
  for (const char c : test::base64(writer.bin)) {
    escaped += c == '/' ? "%2F" : c == '+' ? "%2B" : c == 'A' ? "%41" : std::string(1, c);
    broken += std::string(1, c) + (broken.size() % 20 == 7 ? "\n " : "");
  }
  for (const std::string& uri : {"data:;base64," + escaped, "DATA:x/y;BASE64," + test::base64(writer.bin),
                                 "data:;base64," + broken, "data:x/y; base64," + test::base64(writer.bin)}) {
    const auto file = folder / fresh_name(".gltf");
    test::write_bytes(file, writer.finished(uri).dump());
    EXPECT_EQ(silent(file).triangle_count(), 1u) << uri;
  }
}

TEST_F(SceneTolerance, NamesAsOtherSystemsWriteThem) {
  std::filesystem::create_directory(folder / "sub");
  test::write_bytes(folder / "sub/a.png", picture());
  test::write_bytes(folder / "ns:a.png", picture());
  for (const char* uri : {"sub\\a.png", "sub/a.png?v=3", "sub/a.png#top", "ns%3Aa.png", "./ns:a.png"}) {
    writer = GltfWriter();
    paint({{"index", texture({{"uri", uri}})}});
    textured_triangle();
    EXPECT_EQ(albedo(silent(save()), 1), glm::vec3(0, 1, 0)) << uri;
  }
  for (const char* uri : {"C:\\me\\a.png", "/textures/a.png", "https://example.com/a.png", ""}) {
    writer = GltfWriter();
    paint({{"index", texture({{"uri", uri}})}});
    textured_triangle();
    ::testing::internal::CaptureStderr();
    EXPECT_EQ(albedo(load_scene(save()), 1), glm::vec3(1.0f)) << uri;
    EXPECT_NE(::testing::internal::GetCapturedStderr().find("counts as white"), std::string::npos);
  }
}

TEST_F(SceneTolerance, ChunksOfAGlb) {
  writer.triangle();
  const auto chunk = [](const char* type, std::string content) {
    const auto size = std::uint32_t(content.size());
    return std::string(reinterpret_cast<const char*>(&size), 4) + std::string(type, 4) + content;
  };
  const auto glb = [&](const std::string& chunks) {
    const std::uint32_t header[2] = {2, std::uint32_t(12 + chunks.size())};
    const auto file = folder / fresh_name(".glb");
    test::write_bytes(file, "glTF" + std::string(reinterpret_cast<const char*>(header), 8) + chunks);
    return file;
  };
  const std::string json = writer.finished("x").dump();
  Json inside = writer.finished("x");
  inside["buffers"][0].erase("uri");
  const std::string embedded = writer.finished("data:;base64," + test::base64(writer.bin)).dump();
  const auto padded = [](std::string text) { return text.append((4 - text.size() % 4) % 4, ' '); };
  const std::string own = chunk("JSON", padded(inside.dump()));
  const std::string bin(writer.bin.begin(), writer.bin.end());
  EXPECT_EQ(silent(glb(chunk("JSON", padded(embedded)) + chunk("BIN\0", ""))).triangle_count(), 1u);
  EXPECT_EQ(silent(glb(chunk("JSON", padded(embedded)) + chunk("XTRA", "abcd"))).triangle_count(), 1u);
  EXPECT_EQ(silent(glb(own + chunk("XTRA", "abcd") + chunk("BIN\0", bin))).triangle_count(), 1u);
  EXPECT_EQ(silent(glb(own + chunk("BIN\0", bin + "a"))).triangle_count(), 1u);
}

TEST_F(SceneTolerance, CornersThatAreLeftOver) {
  writer.mesh_node({{"attributes", {{"POSITION", writer.floats({0, 0, 0, 1, 0, 0, 0, 1, 0, 5, 5, 5}, "VEC3")}}}});
  EXPECT_EQ(repaired("not a multiple of three").triangle_count(), 1u);
}

TEST_F(SceneTolerance, ShortNormalsKeepTheirDirection) {
  const int p = writer.floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
  const int n = writer.floats({0.04f, 0, 0.03f, 0.04f, 0, 0.03f, 0.04f, 0, 0.03f}, "VEC3");
  writer.mesh_node({{"attributes", {{"POSITION", p}, {"NORMAL", n}}}});
  const glm::vec3 normal = silent(save()).meshes.at(0).normals[0];
  EXPECT_NEAR(glm::distance(normal, glm::vec3(0.8f, 0.0f, 0.6f)), 0.0f, 1e-6f);
}

TEST_F(SceneTolerance, NodesAndNamesThatSayNothing) {
  writer.triangle();
  writer.root["nodes"][0]["rotation"] = {0, 0, 0, 0};
  EXPECT_EQ(repaired("no unit quaternion").triangle_count(), 1u);
  writer.root["nodes"][0].erase("rotation");
  writer.root["nodes"][0]["name"] = nullptr;
  EXPECT_EQ(repaired("a name is null").triangle_count(), 1u);
  writer.root["nodes"][0].erase("name");
  writer.root["asset"]["version"] = 2.0;
  EXPECT_EQ(repaired("asset.version is a number").triangle_count(), 1u);
  writer.root["asset"] = {{"version", "2.1"}, {"minVersion", "2.1"}};
  refused(save(), "needs glTF 2.1");
}

TEST_F(SceneTolerance, CamerasThatSeeForEver) {
  writer.triangle();
  writer.push("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 1.0}, {"znear", 0.1}, {"zfar", 3.4e38}}}});
  writer.push("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 1.0}, {"znear", 0.0}}}});
  writer.root["nodes"][0]["camera"] = 0;
  const Scene scene = silent(save());
  ASSERT_EQ(scene.cameras.size(), 1u);
  EXPECT_LT(scene.cameras[0].zfar, 100.0f);
  writer.root["nodes"][0]["camera"] = 1;
  refused(save(), "camera 1");
}

TEST_F(SceneTolerance, IntegersWithoutTheWordNormalized) {
  const int p = writer.floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
  const std::vector<std::uint8_t> colors{255, 0, 51, 255, 255, 0, 51, 255, 255, 0, 51, 255};
  const int c = writer.accessor(colors, "VEC4", test::type_ubyte);
  writer.mesh_node({{"attributes", {{"POSITION", p}, {"COLOR_0", c}}}});
  EXPECT_EQ(repaired("without 'normalized'").meshes.at(0).colors[0], glm::vec4(1.0f, 0.0f, 0.2f, 1.0f));
}

}  // namespace
}  // namespace volgi
