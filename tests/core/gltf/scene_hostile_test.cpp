#include <gtest/gtest.h>
#include <sys/stat.h>

#include <functional>
#include <limits>
#include <random>

#include "core/error.h"
#include "core/log.h"
#include "core/scene.h"
#include "core/surface.h"
#include "tests/support/gltf_writer.h"

namespace volgi {
namespace {

namespace fs = std::filesystem;
using test::GltfWriter;
using test::Json;
using test::TemporaryFolder;

/// A file with one of everything: sparse and strided accessors, textures, lights, cameras, animation, hierarchy.
GltfWriter rich_scene() {
  GltfWriter w;
  const int p = w.floats({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0.5f}, "VEC3");
  const int n = w.floats({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
  const int uv = w.floats({0, 0, 1, 0, 0, 1, 1, 1}, "VEC2");
  const int i = w.accessor(std::vector<std::uint16_t>{0, 1, 2, 2, 1, 3}, "SCALAR", test::type_ushort);
  const int sparse_indices = w.view(std::vector<std::uint8_t>{1, 3});
  const int sparse_values = w.view(std::vector<float>{1, 0.1f, 0, 1, 1, 1});
  w.root["accessors"][0]["sparse"] = {{"count", 2},
                                      {"indices", {{"bufferView", sparse_indices}, {"componentType", 5121}}},
                                      {"values", {{"bufferView", sparse_values}}}};
  const std::string image = test::png(2, 2, {255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 255, 255, 255, 0});
  w.push("images", {{"bufferView", w.view(std::vector<char>(image.begin(), image.end()))}, {"mimeType", "image/png"}});
  w.push("samplers", {{"wrapS", 33071}, {"minFilter", 9987}});
  w.push("textures", {{"source", 0}, {"sampler", 0}});
  const Json transform = {{"offset", {0.5, 0}}, {"scale", {2, 2}}, {"texCoord", 0}};
  const Json use = {{"index", 0}, {"extensions", {{"KHR_texture_transform", transform}}}};
  w.push("materials",
         {{"name", "paint"}, {"pbrMetallicRoughness", {{"baseColorTexture", use}, {"metallicFactor", 0.5}}}});
  const Json attributes = {{"POSITION", p}, {"NORMAL", n}, {"TEXCOORD_0", uv}};
  const int leaf = w.mesh_node({{"attributes", attributes}, {"indices", i}, {"material", 0}}, {{"name", "leaf"}});
  w.root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "spot"}, {"spot", {{"outerConeAngle", 0.5}}}}};
  const int light = w.push("nodes", {{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  w.push("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 0.7}, {"znear", 0.1}}}});
  const int camera = w.push("nodes", {{"camera", 0}, {"translation", {0.0, 0.0, 5.0}}});
  const int root = w.push("nodes", {{"children", {leaf, light, camera}}, {"rotation", {0.0, 0.0, 0.0, 1.0}}});
  w.push("scenes", {{"nodes", {root}}});
  w.root["scene"] = 0;
  const Json sampler = {{"input", w.floats({0, 1}, "SCALAR")}, {"output", w.floats({0, 0, 0, 1, 0, 0}, "VEC3")}};
  w.push("animations",
         {{"samplers", Json::array({sampler})},
          {"channels", Json::array({{{"sampler", 0}, {"target", {{"node", root}, {"path", "translation"}}}}})}});
  return w;
}

class Hostile : public ::testing::Test {
 protected:
  /// The file must be refused as bad input, on one line that names it and contains TEXT. What can be repaired is
  /// another test's (scene_tolerance_test.cpp).
  void expect_refused(const fs::path& path, const std::string& text) {
    try {
      load_scene(path, 0.5, {.scene = {}, .animation = {}, .root = {}, .strict = true});
      ADD_FAILURE() << "accepted; expected: " << text;
    } catch (const Error& error) {
      const std::string message = error.what();
      EXPECT_EQ(error.code(), ExitCode::bad_input) << message;
      EXPECT_NE(message.find(path.string()), std::string::npos) << message;
      EXPECT_NE(message.find(text), std::string::npos) << message << "\ndoes not contain: " << text;
      EXPECT_EQ(message.find('\n'), std::string::npos) << message;
      EXPECT_LT(message.size(), 700u);
    }
  }
  void expect_refused(const std::string& text) { expect_refused(writer.save_glb(folder / "scene.glb"), text); }
  /// The rich scene after one change to its JSON.
  void expect_change_refused(const std::string& pointer, const Json& value, const std::string& text) {
    SCOPED_TRACE(pointer + " = " + value.dump());
    writer = rich_scene();
    writer.root[Json::json_pointer(pointer)] = value;
    expect_refused(text);
  }
  void expect_triangle_refused(const std::vector<float>& positions, const std::string& text) {
    writer = GltfWriter();
    writer.mesh_node({{"attributes", {{"POSITION", writer.floats(positions, "VEC3")}}}});
    expect_refused(text);
  }

  TemporaryFolder folder;
  GltfWriter writer;
};

TEST_F(Hostile, TheRichSceneItselfIsGood) {
  const Scene scene = load_scene(rich_scene().save_glb(folder / "scene.glb"), 0.5);
  EXPECT_EQ(scene.triangle_count(), 2u);
  EXPECT_EQ(scene.lights.size(), 1u);
  EXPECT_EQ(scene.cameras.size(), 1u);
  EXPECT_EQ(scene.images.size(), 1u);
}

TEST_F(Hostile, FilesThatAreNotGltf) {
  expect_refused(folder / "missing.glb", "no such file");
  expect_refused(folder.path(), "not a file");
  ASSERT_EQ(mkfifo((folder / "pipe.gltf").c_str(), 0600), 0);
  expect_refused(folder / "pipe.gltf", "not a file");
  const std::vector<std::pair<std::string, std::string>> contents = {
      {"", "not a glTF file"},
      {"hello", "not a glTF file"},
      {"[]", "not a glTF file"},
      {"{}", "asset.version"},
      {"{\"asset\":{\"version\":2}}", "asset.version"},
      {"{\"asset\":{\"version\":\"1.0\"}}", "version 1.0"},
      {std::string("\0\0\0\0", 4), "not a glTF file"},
      {"{\"asset\":{\"version\":\"2.0\"},\"a\":\"\xff\xfe\"}", "not a glTF file"},
      {"{\"asset\":{\"version\":\"2.0\"},\"nodes\":[{\"scale\":[1e999,1,1]}]}", "not a glTF file"},
      {"glTF", "truncated"},
  };
  for (const auto& [bytes, text] : contents) {
    SCOPED_TRACE(bytes);
    test::write_bytes(folder / "bad.gltf", bytes);
    expect_refused(folder / "bad.gltf", text);
  }
}

TEST_F(Hostile, DeepNesting) {
  for (const char* open : {"[", "{\"a\":"}) {
    std::string bytes = "{\"asset\":{\"version\":\"2.0\"},\"extras\":";
    for (int i = 0; i < 200000; ++i) bytes += open;
    test::write_bytes(folder / "deep.gltf", bytes);
    expect_refused(folder / "deep.gltf", "nested");
  }
}

TEST_F(Hostile, NonFinitePositions) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float inf = std::numeric_limits<float>::infinity();
  expect_triangle_refused({0, 0, 0, 1, nan, 0, 0, 1, 0}, "element 1 is nan");
  expect_triangle_refused({0, 0, 0, 1, 0, 0, 0, inf, 0}, "element 2 is inf");
  expect_triangle_refused({0, 0, 0, 1, 0, 0, 0, 3e38f, 0}, "beyond");
}

TEST_F(Hostile, NonFiniteNormalsAndTransforms) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const int p = writer.floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
  const int n = writer.floats({0, 0, 1, 0, nan, 1, 0, 0, 1}, "VEC3");
  writer.mesh_node({{"attributes", {{"POSITION", p}, {"NORMAL", n}}}});
  expect_refused("NORMAL");
  expect_change_refused("/nodes/0/scale", {1e300, 1, 1}, "not finite or beyond");
  writer = rich_scene();
  writer.root["nodes"][0]["scale"] = {1e200, 1e200, 1e200};
  writer.root["nodes"][3]["scale"] = {1e200, 1e200, 1e200};
  expect_refused("not finite");
  expect_change_refused("/nodes/3/rotation", {0, 0, 0, 0}, "unit quaternion");
  expect_change_refused("/nodes/3/matrix", {1, 2, 3}, "matrix");
  expect_change_refused("/nodes/0/matrix", {1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}, "last row");
  expect_change_refused("/nodes/2/scale", {0, 0, 0}, "camera");
}

TEST_F(Hostile, IndicesBetweenElements) {
  for (const int bad : {-1, 99, std::numeric_limits<int>::max()}) {
    for (const char* pointer : {"/nodes/0/mesh",
                                "/nodes/2/camera",
                                "/nodes/1/extensions/KHR_lights_punctual/light",
                                "/nodes/3/children/0",
                                "/scenes/0/nodes/0",
                                "/scene",
                                "/meshes/0/primitives/0/material",
                                "/meshes/0/primitives/0/indices",
                                "/meshes/0/primitives/0/attributes/POSITION",
                                "/meshes/0/primitives/0/attributes/NORMAL",
                                "/accessors/0/bufferView",
                                "/accessors/0/sparse/indices/bufferView",
                                "/accessors/0/sparse/values/bufferView",
                                "/bufferViews/0/buffer",
                                "/images/0/bufferView",
                                "/textures/0/source",
                                "/textures/0/sampler",
                                "/materials/0/pbrMetallicRoughness/baseColorTexture/index",
                                "/animations/0/channels/0/sampler",
                                "/animations/0/channels/0/target/node",
                                "/animations/0/samplers/0/input",
                                "/animations/0/samplers/0/output"}) {
      expect_change_refused(pointer, bad, "");
    }
  }
  writer = rich_scene();
  writer.root["textures"][0].erase("source");
  expect_refused("image");
}

TEST_F(Hostile, PropertiesOfAWrongType) {
  for (const char* pointer :
       {"/nodes/0/mesh", "/scene", "/meshes/0/primitives/0/material", "/accessors/0/count",
        "/accessors/0/componentType", "/bufferViews/0/byteOffset", "/bufferViews/0/byteLength",
        "/materials/0/pbrMetallicRoughness", "/meshes/0/primitives/0/attributes", "/meshes/0/primitives",
        "/nodes/0/scale", "/nodes", "/accessors/0/sparse", "/materials/0/pbrMetallicRoughness/metallicFactor",
        "/cameras/0/perspective", "/cameras/0/perspective/yfov"}) {
    expect_change_refused(pointer, "text", "must be");
    expect_change_refused(pointer, nullptr, "must be");
  }
  expect_change_refused("/accessors/0/count", 1.5, "accessors[0].count");
  expect_change_refused("/accessors/0/type", 3, "accessors[0].type");
}

TEST_F(Hostile, SpecularOutOfRange) {
  const std::string specular = "/materials/0/extensions/KHR_materials_specular";
  for (const char* factor : {"-0.1", "1.1", "1e300"})
    expect_change_refused(specular + "/specularFactor", Json::parse(factor), "material 0 'paint': specularFactor is");
  expect_change_refused(specular + "/specularFactor", "1", "must be a number");
  expect_change_refused(specular + "/specularColorFactor", {1, -1, 1}, "specularColorFactor is -1");
  expect_change_refused(specular + "/specularColorFactor", {1, 1}, "needs three numbers");
  expect_change_refused(specular + "/specularColorFactor", 1, "must be a list of numbers");
  for (const char* ior : {"-1", "0.99", "1e300"})
    expect_change_refused("/materials/0/extensions/KHR_materials_ior/ior", Json::parse(ior), "paint': ior is");
}

TEST_F(Hostile, AccessorsOutsideTheirData) {
  expect_change_refused("/accessors/0/count", 5, "accessor 0");
  expect_change_refused("/accessors/0/count", -4, "count");
  expect_change_refused("/accessors/0/count", 4294967295u, "accessor 0");
  expect_change_refused("/accessors/0/count", 9007199254740992u, "accessor 0");
  expect_change_refused("/accessors/0/count", 18446744073709551615u, "count");
  expect_change_refused("/accessors/0/byteOffset", 4, "accessor 0");
  expect_change_refused("/accessors/0/byteOffset", 9007199254740992u, "accessor 0");
  expect_change_refused("/accessors/0/byteOffset", -4, "byteOffset");
  expect_change_refused("/bufferViews/0/byteStride", 4, "byteStride");
  expect_change_refused("/bufferViews/0/byteStride", 16, "accessor 0");
  expect_change_refused("/bufferViews/0/byteStride", 7, "byteStride");
  expect_change_refused("/bufferViews/0/byteStride", 1000000, "byteStride");
  expect_change_refused("/bufferViews/0/byteOffset", 100000, "outside buffer 0");
  expect_change_refused("/bufferViews/0/byteLength", 9007199254740992u, "outside buffer 0");
  expect_change_refused("/bufferViews/6/byteOffset", 9007199254740992u, "outside buffer 0");  // the image
  expect_change_refused("/accessors/0/sparse/count", 5, "sparse");
  expect_change_refused("/accessors/0/sparse/indices/byteOffset", 1, "sparse indices");
  expect_change_refused("/accessors/0/sparse/values/byteOffset", 4, "sparse values");
  expect_change_refused("/accessors/0/sparse/indices/componentType", 5126, "sparse");
}

TEST_F(Hostile, HugeAccessorsWithoutData) {
  writer = rich_scene();
  writer.root["accessors"][0].erase("bufferView");
  writer.root["accessors"][0]["count"] = 4000000000u;
  expect_refused("without data");
}

TEST_F(Hostile, VertexAndSparseIndicesOutOfRange) {
  writer = rich_scene();
  writer.root["accessors"][3]["bufferView"] = writer.view(std::vector<std::uint16_t>{0, 1, 2, 2, 1, 4});
  expect_refused("index 4 (at position 5) of 4 vertices");
  writer.root["accessors"][3]["bufferView"] = writer.view(std::vector<std::uint16_t>{0, 1, 65535, 2, 1, 3});
  expect_refused("index 65535");
  writer = rich_scene();
  writer.root["accessors"][0]["sparse"]["indices"]["bufferView"] = writer.view(std::vector<std::uint8_t>{0, 4});
  expect_refused("sparse index 4 of 4");
  writer = rich_scene();
  writer.root["accessors"][3]["count"] = 5;
  expect_refused("multiple of three");
}

TEST_F(Hostile, WrongAccessorTypes) {
  expect_change_refused("/accessors/0/type", "VEC2", "POSITION");
  expect_change_refused("/accessors/0/type", "VEC5", "");
  expect_change_refused("/accessors/1/type", "SCALAR", "NORMAL");
  expect_change_refused("/accessors/3/componentType", 5126, "");
  expect_change_refused("/accessors/3/componentType", 5122, "indices");
  expect_change_refused("/accessors/3/componentType", 5130, "");
  expect_change_refused("/accessors/3/componentType", 5127, "");
  expect_change_refused("/accessors/2/count", 3, "TEXCOORD_0 has 3 elements for 4 vertices");
  expect_change_refused("/animations/0/samplers/0/output", 2, "output");
  expect_change_refused("/meshes/0/primitives/0/mode", 7, "mode");
  expect_change_refused("/animations/0/samplers/0/interpolation", "WAVY", "interpolation");
  writer = rich_scene();
  const int times = writer.floats({1, 0}, "SCALAR");
  writer.root["animations"][0]["samplers"][0]["input"] = times;
  expect_refused("do not increase");
}

TEST_F(Hostile, CyclicAndDoublyParentedNodes) {
  expect_change_refused("/nodes/0/children", {3}, "cycle");
  expect_change_refused("/nodes/0/children", {0}, "");
  expect_change_refused("/nodes/2/children", {0}, "child of both");
  expect_change_refused("/nodes/3/children", {0, 0}, "child of both");
  expect_change_refused("/scenes/0/nodes", {3, 3}, "listed twice");
  expect_change_refused("/scenes/0/nodes", {0}, "no root");
  writer = GltfWriter();  // a cycle that no root reaches
  writer.push("nodes", {{"children", {1}}});
  writer.push("nodes", {{"children", {0}}});
  expect_refused("cycle");
}

TEST_F(Hostile, DeepHierarchiesAreNoProblem) {
  writer.triangle();
  const int depth = 20000;
  for (int i = 1; i < depth; ++i) writer.push("nodes", {{"children", {i - 1}}, {"translation", {0.0, 0.0, 1.0}}});
  EXPECT_EQ(load_scene(writer.save_glb(folder / "deep.glb")).world_origin.z, depth - 1);
}

TEST_F(Hostile, InstancesBeyondAllMemory) {
  std::vector<float> positions(3 * 30000);
  for (size_t i = 0; i < positions.size(); ++i) positions[i] = float(i * i % 101);
  writer.mesh_node({{"attributes", {{"POSITION", writer.floats(positions, "VEC3")}}}});
  for (int i = 0; i < 10000; ++i) writer.push("nodes", {{"mesh", 0}});
  try {
    load_scene(writer.save_glb(folder / "many.glb"));
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::over_limit);
  }
}

TEST_F(Hostile, GlbHeaders) {
  const std::string good = rich_scene().glb();
  const auto with_word = [&](size_t offset, std::uint32_t value) {
    std::string bytes = good;
    std::memcpy(&bytes[offset], &value, 4);
    test::write_bytes(folder / "scene.glb", bytes);
    return folder / "scene.glb";
  };
  std::uint32_t json_length = 0;
  std::memcpy(&json_length, &good[12], 4);
  const std::uint32_t size = std::uint32_t(good.size());
  expect_refused(with_word(4, 1), "version 1");
  expect_refused(with_word(8, size + 4), "truncated");
  expect_refused(with_word(8, 4), "");
  expect_refused(with_word(8, 0xffffffff), "truncated");
  expect_refused(with_word(12, 0xffffffff), "chunk");
  expect_refused(with_word(12, 0), "");
  expect_refused(with_word(16, 0x004e4942), "JSON chunk");
  for (const std::uint32_t excess : {4u, 8u, 0x7ffffff0u}) {
    std::uint32_t bin_length = 0;
    std::memcpy(&bin_length, &good[20 + json_length], 4);
    expect_refused(with_word(20 + json_length, bin_length + excess), "chunk");
  }
}

TEST_F(Hostile, EveryTruncationOfAGlb) {
  const std::string good = rich_scene().glb();
  for (size_t length = 0; length < good.size(); length += 7) {
    SCOPED_TRACE(length);
    test::write_bytes(folder / "cut.glb", good.substr(0, length));
    expect_refused(folder / "cut.glb", "");
  }
}

TEST_F(Hostile, TruncatedAndMissingBuffers) {
  writer = rich_scene();
  const fs::path path = writer.save_gltf(folder / "scene.gltf");
  test::write_bytes(folder / "data.bin", writer.bin.substr(0, 40));
  expect_refused(path, "data.bin");
  fs::remove(folder / "data.bin");
  expect_refused(path, "missing file 'data.bin'");
  fs::create_directory(folder / "data.bin");
  expect_refused(path, "not a file");
  writer.root["buffers"] = Json::array({{{"byteLength", 64}}});
  expect_refused(writer.save_embedded(folder / "nothing.gltf"), "");
  writer.root["buffers"] = Json::array({{{"byteLength", 64}, {"uri", "data:application/octet-stream;base64,AAAA"}}});
  expect_refused(writer.save_embedded(folder / "short.gltf"), "");
  writer.root["buffers"] = Json::array({{{"byteLength", 64}, {"uri", "data:audio/wav;base64,AAAA"}}});
  expect_refused(writer.save_embedded(folder / "type.gltf"), "3 bytes instead of 64");
}

TEST_F(Hostile, UrisThatLeaveTheFolder) {
  fs::create_directories(folder / "in/sub");
  writer = rich_scene();
  test::write_bytes(folder / "secret.bin", writer.bin);
  test::write_bytes(folder / "in/good.bin", writer.bin);
  fs::create_symlink(folder / "secret.bin", folder / "in/link.bin");
  fs::create_directory_symlink(folder.path(), folder / "in/folder");
  const fs::path path = folder / "in/scene.gltf";
  const std::string secret = (folder / "secret.bin").string();
  for (const std::string& uri :
       {std::string("../secret.bin"), std::string("sub/../../secret.bin"), std::string("%2e%2e/secret.bin"),
        std::string("%2e%2e%2fsecret.bin"), std::string("..%2Fsecret.bin"), secret, "file://" + secret,
        "%2F" + secret.substr(1), std::string("http://localhost/secret.bin"), std::string("link.bin"),
        std::string("folder/secret.bin"), std::string("C:\\secret.bin")}) {
    SCOPED_TRACE(uri);
    test::write_bytes(path, writer.finished(uri).dump());
    expect_refused(path, "which is not allowed");
    GltfWriter image = rich_scene();
    image.root["images"][0] = {{"uri", uri}};
    expect_refused(image.save_glb(folder / "in/scene.glb"), "which is not allowed");
  }
  for (const std::string& uri : {std::string("nul%00.bin"), std::string("")}) {
    SCOPED_TRACE(uri);
    Json json = writer.finished("x");
    json["buffers"][0]["uri"] = uri;
    test::write_bytes(path, json.dump());
    expect_refused(path, "malformed URI");
  }
  for (const char* uri : {"good.bin", "sub/../good.bin", "./good.bin"}) {
    test::write_bytes(path, writer.finished(uri).dump());
    EXPECT_EQ(load_scene(path).triangle_count(), 2u);
  }
}

TEST_F(Hostile, Images) {
  writer = rich_scene();
  writer.root["images"][0] = {{"uri", "none.png"}};
  expect_refused("missing file 'none.png'");
  test::write_bytes(folder / "none.png", "not a picture");
  expect_refused("image 0 'none.png'");
  test::write_bytes(folder / "none.png", std::string("GIF89a\1\0\1\0\0\0\0", 13));
  expect_refused("image 0 'none.png'");
  const std::string good = test::png(2, 2, std::vector<std::uint8_t>(16, 200));
  test::write_bytes(folder / "none.png", good.substr(0, good.size() / 2));
  expect_refused("cannot be decoded");
  std::string huge = good;
  huge.replace(16, 8, std::string("\0\0\x7f\xff\0\0\x7f\xff", 8));
  test::write_bytes(folder / "none.png", huge);
  expect_refused("image 0 'none.png'");
  test::write_bytes(folder / "none.png", "");
  expect_refused("image");
  writer.root["images"][0] = Json::object();
  expect_refused("image");
}

TEST_F(Hostile, RequiredExtensions) {
  writer = rich_scene();
  writer.root["extensionsRequired"] = {"VENDOR_new_geometry"};
  expect_refused("VENDOR_new_geometry");
  writer.root["extensionsRequired"] = {3};
  expect_refused("extensionsRequired");
  writer.root["extensionsRequired"] = {"KHR_texture_transform", "KHR_lights_punctual",
                                       "KHR_materials_emissive_strength"};
  EXPECT_EQ(load_scene(writer.save_glb(folder / "good.glb")).triangle_count(), 2u);
}

TEST_F(Hostile, LightsCamerasAndMaterials) {
  const std::string light = "/extensions/KHR_lights_punctual/lights/0/";
  expect_change_refused(light + "intensity", -1, "light 0");
  expect_change_refused(light + "intensity", 1e300, "light 0");
  expect_change_refused(light + "color", {1, 1}, "light 0");
  expect_change_refused(light + "color", {1, -1, 1}, "light 0");
  expect_change_refused(light + "range", -2, "range");
  expect_change_refused(light + "type", "laser", "laser");
  expect_change_refused(light + "spot/outerConeAngle", 2, "cone");
  expect_change_refused(light + "spot/innerConeAngle", 0.6, "cone");
  expect_change_refused("/cameras/0/perspective/yfov", 0, "camera 0");
  expect_change_refused("/cameras/0/perspective/yfov", 3.2, "camera 0");
  expect_change_refused("/cameras/0/perspective/znear", 0, "camera 0");
  expect_change_refused("/cameras/0/perspective/zfar", 0.05, "camera 0");
  expect_change_refused("/cameras/0/type", "fisheye", "");
  expect_change_refused("/materials/0/pbrMetallicRoughness/metallicFactor", 2, "metallicFactor");
  expect_change_refused("/materials/0/pbrMetallicRoughness/baseColorFactor", {1, 1, 1, 1e300}, "baseColorFactor");
  expect_change_refused("/materials/0/emissiveFactor", {-1, 0, 0}, "emissiveFactor");
  expect_change_refused("/materials/0/alphaMode", "GLASS", "GLASS");
  expect_change_refused("/samplers/0/wrapS", 5, "wrap mode");
  expect_change_refused("/samplers/0/minFilter", 5, "minFilter");
}

TEST_F(Hostile, NamesCannotForgeTheTerminal) {
  writer = rich_scene();
  writer.root["nodes"][0]["name"] = std::string("a\nvolgi: all is well\x1b[2J") + std::string(100000, 'x');
  writer.root["nodes"][0]["mesh"] = 7;
  expect_refused("mesh 7");
}

/// Any damage is either harmless or refused. The same damage every time; a sanitizer build shows what a crash hides.
TEST_F(Hostile, RandomDamage) {
  set_quiet(true);
  const std::string glb = rich_scene().glb();
  const std::string gltf =
      rich_scene().finished("data:application/octet-stream;base64," + test::base64(rich_scene().bin)).dump();
  std::mt19937 random(1);
  int refused = 0;
  const auto load_all = [&](const fs::path& path, const std::string& bytes) {
    test::write_bytes(path, bytes);
    try {
      const Scene scene = load_scene(path, 0.3);
      for (const Mesh& mesh : scene.meshes) {
        for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) surface_point(scene, mesh, t, 0.3f, 0.3f);
      }
      largest_albedo(scene);
    } catch (const Error& error) {
      ++refused;
      EXPECT_TRUE(error.code() == ExitCode::bad_input || error.code() == ExitCode::over_limit) << error.what();
    }
  };
  constexpr int rounds = 400;
  for (int round = 0; round < rounds; ++round) {
    for (const std::string& good : {glb, gltf}) {
      std::string bytes = good;
      for (unsigned k = 0; k < 1 + round % 4u; ++k) {
        char& byte = bytes[random() % bytes.size()];
        byte = random() % 2 == 0 ? char(random()) : "0123456789-,:[]{}\"e."[random() % 20];
      }
      load_all(folder / "damaged", bytes);
    }
  }
  set_quiet(false);
  EXPECT_GT(refused, rounds / 2);
  EXPECT_LT(refused, 2 * rounds);
}

}  // namespace
}  // namespace volgi
