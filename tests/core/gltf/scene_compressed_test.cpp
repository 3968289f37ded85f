// Compressed files against the same ones uncompressed, and damaged ones.
#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <gtest/gtest.h>
#include <meshoptimizer.h>
#include <webp/encode.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>

#include "core/error.h"
#include "core/log.h"
#include "core/scene.h"
#include "core/surface.h"
#include "tests/support/gltf_writer.h"

namespace volgi {
namespace {

using test::GltfWriter;
using test::Json;
using test::TemporaryFolder;

struct Grid {
  std::vector<float> positions, normals, uv;
  std::vector<std::uint32_t> indices;
};

/// A wavy sheet of 2 n^2 triangles.
Grid wavy(int n) {
  Grid g;
  for (int y = 0; y <= n; ++y) {
    for (int x = 0; x <= n; ++x) {
      const float u = float(x) / float(n), v = float(y) / float(n);
      g.positions.insert(g.positions.end(), {u, v, 0.1f * std::sin(7.0f * u)});
      g.normals.insert(g.normals.end(), {0, 0, 1});
      g.uv.insert(g.uv.end(), {u, v});
      if (x == n || y == n) continue;
      const auto at = std::uint32_t(y * (n + 1) + x), row = std::uint32_t(n + 1);
      g.indices.insert(g.indices.end(), {at, at + 1, at + row, at + row, at + 1, at + row + 1});
    }
  }
  return g;
}

class SceneCompressed : public ::testing::Test {
 protected:
  void SetUp() override { set_quiet(true); }
  void TearDown() override { set_quiet(false); }
  static std::vector<glm::vec3> sorted_corners(const Scene& scene) {
    std::vector<glm::vec3> corners;
    for (const Mesh& m : scene.meshes) {
      for (const glm::uvec3& t : m.triangles) {
        for (int k = 0; k < 3; ++k) corners.push_back(m.positions[t[k]]);
      }
    }
    std::sort(corners.begin(), corners.end(),
              [](glm::vec3 a, glm::vec3 b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); });
    return corners;
  }
  void expect_like(const GltfWriter& plain, float tolerance) {
    const auto expected = sorted_corners(load_scene(plain.save_glb(folder / "plain.glb")));
    const auto found = sorted_corners(load_scene(writer.save_glb(folder / "compressed.glb")));
    ASSERT_EQ(found.size(), expected.size());
    for (size_t i = 0; i < found.size(); ++i) EXPECT_LT(glm::distance(found[i], expected[i]), tolerance) << i;
  }
  static GltfWriter plain(const Grid& g) {
    GltfWriter w;
    const Json attributes = {{"POSITION", w.floats(g.positions, "VEC3")},
                             {"NORMAL", w.floats(g.normals, "VEC3")},
                             {"TEXCOORD_0", w.floats(g.uv, "VEC2")}};
    w.mesh_node({{"attributes", attributes}, {"indices", w.accessor(g.indices, "SCALAR", test::type_uint)}});
    return w;
  }
  /// Thousands of damaged files: refused or read, within memory.
  void survive(int mutations) {
    if (std::getenv("VOLGI_LONG") != nullptr) mutations = 10000;
    std::mt19937 random(3);
    const std::string good = writer.glb();
    const size_t json = good.find("BIN", 12);
    int read = 0;
    for (int i = 0; i < mutations; ++i) {
      std::string bad = good;
      const int changes = 1 + int(random() % 4);
      for (int c = 0; c < changes; ++c) bad[json + 4 + random() % (bad.size() - json - 4)] = char(random());
      test::write_bytes(folder / "bad.glb", bad);
      try {
        load_scene(folder / "bad.glb");
        ++read;
      } catch (const Error& e) {
        EXPECT_NE(e.code(), ExitCode::usage);
      }
    }
    RecordProperty("read", read);
  }

  TemporaryFolder folder;
  GltfWriter writer;
};

class Meshopt : public SceneCompressed {
 protected:
  int compressed_view(const std::vector<unsigned char>& data, size_t stride, size_t count, const std::string& mode,
                      const std::string& filter = "NONE") {
    const int inner = writer.view(data);
    const Json at = writer.root["bufferViews"][size_t(inner)];
    Json view = {{"buffer", fallback}, {"byteOffset", 0}, {"byteLength", stride * count}};
    if (mode == "ATTRIBUTES") view["byteStride"] = stride;
    view["extensions"]["EXT_meshopt_compression"] = {{"buffer", 0},
                                                     {"byteOffset", at["byteOffset"]},
                                                     {"byteLength", at["byteLength"]},
                                                     {"byteStride", stride},
                                                     {"count", count},
                                                     {"mode", mode},
                                                     {"filter", filter}};
    return writer.push("bufferViews", view);
  }
  int accessor(int view, const std::string& type, int component, size_t count, bool normalized = false) {
    Json a = {{"bufferView", view}, {"componentType", component}, {"count", count}, {"type", type}};
    if (normalized) a["normalized"] = true;
    return writer.push("accessors", a);
  }
  void build(const Grid& g) {
    const size_t n = g.positions.size() / 3;
    std::vector<unsigned char> p(meshopt_encodeVertexBufferBound(n, 12));
    p.resize(meshopt_encodeVertexBuffer(p.data(), p.size(), g.positions.data(), n, 12));
    std::vector<unsigned char> i(meshopt_encodeIndexBufferBound(g.indices.size(), n));
    i.resize(meshopt_encodeIndexBuffer(i.data(), i.size(), g.indices.data(), g.indices.size()));
    std::vector<std::int8_t> oct(4 * n);  // of the normals
    meshopt_encodeFilterOct(oct.data(), n, 4, 8, with_w(g.normals).data());
    std::vector<unsigned char> o(meshopt_encodeVertexBufferBound(n, 4));
    o.resize(meshopt_encodeVertexBuffer(o.data(), o.size(), oct.data(), n, 4));
    const int position = accessor(compressed_view(p, 12, n, "ATTRIBUTES"), "VEC3", test::type_float, n);
    const int normal = accessor(compressed_view(o, 4, n, "ATTRIBUTES", "OCTAHEDRAL"), "VEC3", test::type_byte, n, true);
    const int index =
        accessor(compressed_view(i, 4, g.indices.size(), "TRIANGLES"), "SCALAR", test::type_uint, g.indices.size());
    writer.mesh_node({{"attributes", {{"POSITION", position}, {"NORMAL", normal}}}, {"indices", index}});
    writer.root["extensionsUsed"] = writer.root["extensionsRequired"] = {"EXT_meshopt_compression"};
    const Json unused = {{"byteLength", 12 * n + 4 * n + 4 * g.indices.size()},
                         {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}};
    writer.root["buffers"] = {{{"byteLength", writer.bin.size()}}, unused};
  }
  static std::vector<float> with_w(const std::vector<float>& three) {
    std::vector<float> four;
    for (size_t i = 0; i < three.size(); i += 3) four.insert(four.end(), {three[i], three[i + 1], three[i + 2], 0.0f});
    return four;
  }
  int fallback = 1;
};

TEST_F(Meshopt, AsUncompressed) {
  const Grid g = wavy(20);
  build(g);
  expect_like(plain(g), 1e-6f);
  const Scene scene = load_scene(folder / "compressed.glb");
  for (const glm::vec3& n : scene.meshes.at(0).normals) EXPECT_GT(n.z, 0.999f);
}

TEST_F(Meshopt, DamagedDataAreRefused) {
  build(wavy(8));
  survive(2000);
}

TEST_F(Meshopt, WrongNumbersAreRefused) {
  build(wavy(4));
  Json& view = writer.root["bufferViews"][1]["extensions"]["EXT_meshopt_compression"];
  const Json good = view;
  for (const auto& [name, value] : {std::pair<const char*, Json>("byteStride", 13),
                                    {"byteStride", 260},
                                    {"count", 4e9},
                                    {"count", -3},
                                    {"mode", "TRIANGLES"},
                                    {"mode", "X"},
                                    {"filter", "QUATERNION"},
                                    {"filter", 7},
                                    {"buffer", 9},
                                    {"byteOffset", 1e6},
                                    {"byteLength", 0}}) {
    view = good;
    view[name] = value;
    if (std::string(name) == "filter" && value == 7) continue;  // no text: as without one
    EXPECT_THROW(load_scene(writer.save_glb(folder / "wrong.glb")), Error) << name << " " << value;
  }
}

class Draco : public SceneCompressed {
 protected:
  void build(const Grid& g, bool quantized) {
    draco::TriangleSoupMeshBuilder builder;
    const auto faces = int(g.indices.size() / 3);
    builder.Start(faces);
    const int p = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
    const int n = builder.AddAttribute(draco::GeometryAttribute::NORMAL, 3, draco::DT_FLOAT32);
    const int t = builder.AddAttribute(draco::GeometryAttribute::TEX_COORD, 2, draco::DT_FLOAT32);
    for (int f = 0; f < faces; ++f) {
      const auto at = [&](int k) { return size_t(g.indices[size_t(3 * f + k)]); };
      const draco::FaceIndex face{std::uint32_t(f)};
      builder.SetAttributeValuesForFace(p, face, &g.positions[3 * at(0)], &g.positions[3 * at(1)],
                                        &g.positions[3 * at(2)]);
      builder.SetAttributeValuesForFace(n, face, &g.normals[3 * at(0)], &g.normals[3 * at(1)], &g.normals[3 * at(2)]);
      builder.SetAttributeValuesForFace(t, face, &g.uv[2 * at(0)], &g.uv[2 * at(1)], &g.uv[2 * at(2)]);
    }
    const std::unique_ptr<draco::Mesh> mesh = builder.Finalize();
    draco::Encoder encoder;
    if (quantized) {
      encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, 14);
      encoder.SetAttributeQuantization(draco::GeometryAttribute::NORMAL, 10);
      encoder.SetAttributeQuantization(draco::GeometryAttribute::TEX_COORD, 12);
    }
    draco::EncoderBuffer buffer;
    ASSERT_TRUE(encoder.EncodeMeshToBuffer(*mesh, &buffer).ok());
    const int view = writer.view(std::vector<char>(buffer.data(), buffer.data() + buffer.size()));
    const size_t points = mesh->num_points();
    const auto accessor = [&](const char* type, int component, size_t count) {
      return writer.push("accessors", {{"componentType", component}, {"count", count}, {"type", type}});
    };
    const Json attributes = {{"POSITION", accessor("VEC3", 5126, points)},
                             {"NORMAL", accessor("VEC3", 5126, points)},
                             {"TEXCOORD_0", accessor("VEC2", 5126, points)}};
    const Json ids = {{"POSITION", mesh->attribute(p)->unique_id()},
                      {"NORMAL", mesh->attribute(n)->unique_id()},
                      {"TEXCOORD_0", mesh->attribute(t)->unique_id()}};
    writer.mesh_node({{"attributes", attributes},
                      {"indices", accessor("SCALAR", 5125, size_t(3 * faces))},
                      {"extensions", {{"KHR_draco_mesh_compression", {{"bufferView", view}, {"attributes", ids}}}}}});
    writer.root["extensionsUsed"] = writer.root["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  }
};

TEST_F(Draco, AsUncompressed) {
  const Grid g = wavy(16);
  build(g, false);
  expect_like(plain(g), 1e-6f);
}

TEST_F(Draco, QuantizedToItsBits) {
  const Grid g = wavy(16);
  build(g, true);
  expect_like(plain(g), 3.0f / 16384.0f);
  const Scene scene = load_scene(folder / "compressed.glb");
  const Mesh& m = scene.meshes.at(0);
  for (size_t i = 0; i < m.positions.size(); ++i) {
    const glm::dvec3 at = scene.world_origin + glm::dvec3(m.positions[i]);
    EXPECT_NEAR(double(m.uv[0].at(i).x), at.x, 2e-3);  // it is the position, in this sheet
    EXPECT_NEAR(double(m.uv[0].at(i).y), at.y, 2e-3);
  }
}

TEST_F(Draco, DamagedDataAreRefused) {
  build(wavy(8), true);
  survive(2000);
}

class WebP : public SceneCompressed {};

TEST_F(WebP, AsPng) {
  const std::vector<std::uint8_t> rgba{255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 90, 80, 70, 255};
  std::uint8_t* encoded = nullptr;
  const size_t size = WebPEncodeLosslessRGBA(rgba.data(), 2, 2, 8, &encoded);
  ASSERT_GT(size, 0u);
  const int view = writer.view(std::vector<std::uint8_t>(encoded, encoded + size));
  WebPFree(encoded);
  writer.push("images", {{"bufferView", view}, {"mimeType", "image/webp"}});
  writer.push("textures", {{"extensions", {{"EXT_texture_webp", {{"source", 0}}}}}});
  writer.push("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
  const Grid g = wavy(1);
  const Json attributes = {{"POSITION", writer.floats(g.positions, "VEC3")},
                           {"TEXCOORD_0", writer.floats(g.uv, "VEC2")}};
  writer.mesh_node(
      {{"attributes", attributes}, {"material", 0}, {"indices", writer.accessor(g.indices, "SCALAR", 5125)}});
  writer.root["extensionsUsed"] = writer.root["extensionsRequired"] = {"EXT_texture_webp"};
  const Scene scene = load_scene(writer.save_glb(folder / "webp.glb"));
  ASSERT_EQ(scene.images.size(), 1u);
  EXPECT_EQ(scene.images[0].rgba.bytes(), rgba);
  survive(1000);
}

TEST_F(SceneCompressed, QuantizedMeshes) {
  const Grid g = wavy(8);
  std::vector<std::uint16_t> p;
  for (size_t i = 0; i < g.positions.size(); i += 3) {
    for (size_t c = 0; c < 3; ++c) p.push_back(std::uint16_t(std::lround(double(g.positions[i + c] + 0.5f) * 1000.0)));
    p.push_back(0);
  }
  const int view = writer.view(p, 8);
  const int position = writer.push("accessors", {{"bufferView", view},
                                                 {"componentType", test::type_ushort},
                                                 {"count", g.positions.size() / 3},
                                                 {"type", "VEC3"}});
  writer.mesh_node({{"attributes", {{"POSITION", position}}}, {"indices", writer.accessor(g.indices, "SCALAR", 5125)}},
                   {{"scale", {1e-3, 1e-3, 1e-3}}, {"translation", {-0.5, -0.5, -0.5}}});
  writer.root["extensionsUsed"] = writer.root["extensionsRequired"] = {"KHR_mesh_quantization"};
  expect_like(plain(g), 2e-3f);
}

}  // namespace
}  // namespace volgi
