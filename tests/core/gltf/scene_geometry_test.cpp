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

const std::vector<float> square = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};

glm::vec3 front(const Mesh& mesh, size_t triangle) {
  const glm::uvec3 t = mesh.triangles[triangle];
  const glm::vec3 a = mesh.positions[t.x];
  return glm::normalize(glm::cross(mesh.positions[t.y] - a, mesh.positions[t.z] - a));
}

/// File's world position of a corner.
glm::vec3 world(const Scene& scene, std::uint32_t vertex, size_t mesh = 0) {
  return glm::vec3(glm::dvec3(scene.meshes[mesh].positions[vertex]) + scene.world_origin);
}

void expect_near(glm::vec3 a, glm::vec3 b, float tolerance) {
  EXPECT_LT(glm::distance(a, b), tolerance)
      << a.x << " " << a.y << " " << a.z << " instead of " << b.x << " " << b.y << " " << b.z;
}

class SceneGeometry : public ::testing::Test {
 protected:
  Scene load() { return load_scene(writer.save_glb(folder / "scene.glb")); }
  /// A square as two triangles of the given mode, from `corners` (indices) or in the file's order.
  Scene load_square(int mode, const std::vector<std::uint32_t>& corners) {
    Json primitive = {{"mode", mode}, {"attributes", {{"POSITION", writer.floats(square, "VEC3")}}}};
    if (!corners.empty()) primitive["indices"] = writer.accessor(corners, "SCALAR", test::type_uint);
    writer.mesh_node(primitive);
    return load();
  }

  TemporaryFolder folder;
  GltfWriter writer;
};

TEST_F(SceneGeometry, GlbGltfAndDataUriGiveTheSameScene) {
  writer.triangle();
  const Scene glb = load_scene(writer.save_glb(folder / "a.glb"));
  const Scene gltf = load_scene(writer.save_gltf(folder / "b.gltf"));
  const Scene embedded = load_scene(writer.save_embedded(folder / "c.gltf"));
  ASSERT_EQ(glb.triangle_count(), 1u);
  EXPECT_EQ(glb.name, "a");
  EXPECT_EQ(glb.meshes[0].positions, gltf.meshes[0].positions);
  EXPECT_EQ(glb.meshes[0].positions, embedded.meshes[0].positions);
  EXPECT_EQ(glb.meshes[0].object_id, 1u);
}

TEST_F(SceneGeometry, PercentEncodedAndNestedBufferNames) {
  std::filesystem::create_directory(folder / "sub");
  writer.triangle();
  writer.save_gltf(folder / "scene.gltf");
  for (const auto& [uri, name] : std::vector<std::pair<std::string, std::string>>{
           {"sub/a%20b%2Ec.bin", "sub/a b.c.bin"}, {"./plus+plus.bin", "plus+plus.bin"}, {"%C3%A4.bin", "ä.bin"}}) {
    test::write_bytes(folder / name, writer.bin);
    test::write_bytes(folder / "scene.gltf", writer.finished(uri).dump());
    EXPECT_EQ(load_scene(folder / "scene.gltf").triangle_count(), 1u) << uri;
  }
}

TEST_F(SceneGeometry, OriginIsTheCentreOfTheBounds) {
  writer.triangle({{"translation", {10.0, 20.0, 30.0}}});
  const Scene scene = load();
  EXPECT_EQ(scene.world_origin, glm::dvec3(10.5, 20.5, 30.0));
  EXPECT_EQ(scene.bounds_min, glm::vec3(-0.5f, -0.5f, 0.0f));
  EXPECT_EQ(scene.bounds_max, glm::vec3(0.5f, 0.5f, 0.0f));
}

TEST_F(SceneGeometry, EmptyFileHasZeroBoundsAndAMaterial) {
  const Scene scene = load();
  EXPECT_EQ(scene.triangle_count(), 0u);
  EXPECT_EQ(scene.bounds_min, glm::vec3(0.0f));
  EXPECT_EQ(scene.bounds_max, glm::vec3(0.0f));
  EXPECT_EQ(scene.world_origin, glm::dvec3(0.0));
  EXPECT_EQ(scene.materials.size(), 1u);
}

TEST_F(SceneGeometry, StripKeepsItsWinding) {
  const Scene scene = load_square(5, {});
  ASSERT_EQ(scene.triangle_count(), 2u);
  expect_near(front(scene.meshes[0], 0), {0, 0, 1}, 1e-6f);
  expect_near(front(scene.meshes[0], 1), {0, 0, 1}, 1e-6f);
}

TEST_F(SceneGeometry, FanKeepsItsWinding) {
  const Scene scene = load_square(6, {0, 1, 3, 2});
  ASSERT_EQ(scene.triangle_count(), 2u);
  expect_near(front(scene.meshes[0], 0), {0, 0, 1}, 1e-6f);
  expect_near(front(scene.meshes[0], 1), {0, 0, 1}, 1e-6f);
}

TEST_F(SceneGeometry, PointsAndLinesAreIgnored) {
  for (const int mode : {0, 1, 2, 3}) {
    writer.mesh_node({{"mode", mode}, {"attributes", {{"POSITION", writer.floats(square, "VEC3")}}}});
  }
  EXPECT_EQ(load().triangle_count(), 0u);
}

TEST_F(SceneGeometry, IndicesOfEveryWidth) {
  const int positions = writer.floats(square, "VEC3");
  double z = 0.0;
  const auto add = [&](int indices) {
    writer.mesh_node({{"indices", indices}, {"attributes", {{"POSITION", positions}}}},
                     {{"translation", {0.0, 0.0, z--}}});
  };
  add(writer.accessor(std::vector<std::uint8_t>{0, 1, 3}, "SCALAR", test::type_ubyte));
  add(writer.accessor(std::vector<std::uint16_t>{0, 1, 3}, "SCALAR", test::type_ushort));
  add(writer.accessor(std::vector<std::uint32_t>{0, 1, 3}, "SCALAR", test::type_uint));
  const Scene scene = load();
  ASSERT_EQ(scene.meshes.size(), 3u);
  for (size_t m = 0; m < 3; ++m) {
    EXPECT_EQ(scene.meshes[m].object_id, m + 1);
    const glm::uvec3 t = scene.meshes[m].triangles[0];
    expect_near(world(scene, t.z, m), {1, 1, -float(m)}, 1e-6f);
  }
}

TEST_F(SceneGeometry, InterleavedBufferView) {
  struct Vertex {
    float position[3];
    float normal[3];
  };
  const std::vector<Vertex> vertices = {{{0, 0, 0}, {0, 0, 1}}, {{2, 0, 0}, {0, 1, 0}}, {{0, 2, 0}, {1, 0, 0}}};
  const int view = writer.view(vertices, sizeof(Vertex));
  const Json common = {{"bufferView", view}, {"componentType", 5126}, {"count", 3}, {"type", "VEC3"}};
  Json normal = common;
  normal["byteOffset"] = 12;
  const int p = writer.push("accessors", common);
  const int n = writer.push("accessors", normal);
  writer.mesh_node({{"attributes", {{"POSITION", p}, {"NORMAL", n}}}});
  const Scene scene = load();
  expect_near(world(scene, 1), {2, 0, 0}, 1e-6f);
  expect_near(scene.meshes[0].normals[1], {0, 1, 0}, 1e-6f);
  expect_near(scene.meshes[0].normals[2], {1, 0, 0}, 1e-6f);
}

TEST_F(SceneGeometry, SparseAccessorsWithAndWithoutBase) {
  const int indices = writer.view(std::vector<std::uint16_t>{1, 2});
  const int values = writer.view(std::vector<float>{3, 0, 0, 0, 4, 0});
  const Json sparse = {{"count", 2},
                       {"indices", {{"bufferView", indices}, {"componentType", 5123}}},
                       {"values", {{"bufferView", values}}}};
  const int zero =
      writer.push("accessors", {{"componentType", 5126}, {"count", 3}, {"type", "VEC3"}, {"sparse", sparse}});
  const int moved = writer.floats({0, 0, 1, 9, 9, 9, 9, 9, 9}, "VEC3");
  writer.root["accessors"][size_t(moved)]["sparse"] = sparse;
  writer.mesh_node({{"attributes", {{"POSITION", zero}}}});
  writer.mesh_node({{"attributes", {{"POSITION", moved}}}});
  const Scene scene = load();
  ASSERT_EQ(scene.meshes.size(), 2u);
  expect_near(world(scene, 0, 0), {0, 0, 0}, 1e-6f);
  expect_near(world(scene, 2, 0), {0, 4, 0}, 1e-6f);
  expect_near(world(scene, 0, 1), {0, 0, 1}, 1e-6f);
  expect_near(world(scene, 1, 1), {3, 0, 0}, 1e-6f);
}

TEST_F(SceneGeometry, QuantizedPositionsAndNormals) {
  writer.root["extensionsUsed"] = writer.root["extensionsRequired"] = {"KHR_mesh_quantization"};
  const int p =
      writer.accessor(std::vector<std::int16_t>{0, 0, 0, 32767, 0, 0, 0, -32767, 0}, "VEC3", test::type_short, true);
  const int plain = writer.accessor(std::vector<std::uint8_t>{0, 0, 0, 200, 0, 0, 0, 100, 0}, "VEC3", test::type_ubyte);
  const int n =
      writer.accessor(std::vector<std::int8_t>{0, 0, 127, 0, -128, 0, 90, 0, 90}, "VEC3", test::type_byte, true);
  writer.mesh_node({{"attributes", {{"POSITION", p}, {"NORMAL", n}}}});
  writer.mesh_node({{"attributes", {{"POSITION", plain}}}});
  const Scene scene = load();
  expect_near(world(scene, 1, 0), {1, 0, 0}, 1e-5f);
  expect_near(world(scene, 2, 0), {0, -1, 0}, 1e-5f);
  expect_near(world(scene, 1, 1), {200, 0, 0}, 1e-4f);
  expect_near(scene.meshes[0].normals[1], {0, -1, 0}, 1e-6f);
  expect_near(scene.meshes[0].normals[2], {std::sqrt(0.5f), 0, std::sqrt(0.5f)}, 1e-6f);
}

TEST_F(SceneGeometry, VertexColoursOfEveryKind) {
  const int p = writer.floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
  double z = 0.0;
  const auto add = [&](int colors) {
    writer.mesh_node({{"attributes", {{"POSITION", p}, {"COLOR_0", colors}}}}, {{"translation", {0.0, 0.0, z++}}});
  };
  add(writer.floats({0.2f, 0.4f, 0.6f, 0, 0, 0, 0, 0, 0}, "VEC3"));
  add(writer.floats({0.2f, 0.4f, 0.6f, 0.5f, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC4"));
  add(writer.accessor(std::vector<std::uint8_t>{51, 102, 153, 128, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC4", test::type_ubyte,
                      true));
  add(writer.accessor(std::vector<std::uint16_t>{13107, 26214, 39321, 0, 0, 0, 0, 0, 0}, "VEC3", test::type_ushort,
                      true));
  const Scene scene = load();
  ASSERT_EQ(scene.meshes.size(), 4u);
  for (const Mesh& mesh : scene.meshes) expect_near(glm::vec3(mesh.colors[0]), {0.2f, 0.4f, 0.6f}, 1e-5f);
  EXPECT_FLOAT_EQ(scene.meshes[0].colors[0].w, 1.0f);
  EXPECT_FLOAT_EQ(scene.meshes[1].colors[0].w, 0.5f);
  EXPECT_NEAR(scene.meshes[2].colors[0].w, 128.0 / 255.0, 1e-6);
}

TEST_F(SceneGeometry, MissingNormalsAreFlatAndUnshared) {
  // Two triangles that share an edge and meet at a right angle.
  const int p = writer.floats({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, "VEC3");
  const int uv = writer.floats({0, 0, 1, 0, 0, 1, 1, 1}, "VEC2");
  const int i = writer.accessor(std::vector<std::uint16_t>{0, 1, 2, 0, 3, 1}, "SCALAR", test::type_ushort);
  writer.mesh_node({{"indices", i}, {"attributes", {{"POSITION", p}, {"TEXCOORD_0", uv}}}});
  const Scene scene = load();
  const Mesh& mesh = scene.meshes[0];
  ASSERT_EQ(mesh.positions.size(), 6u);
  ASSERT_EQ(mesh.uv[0].size(), 6u);
  for (size_t t = 0; t < 2; ++t) {
    for (int c = 0; c < 3; ++c) expect_near(mesh.normals[mesh.triangles[t][c]], front(mesh, t), 1e-6f);
  }
  expect_near(front(mesh, 0), {0, 0, 1}, 1e-6f);
  expect_near(front(mesh, 1), {0, 1, 0}, 1e-6f);
  EXPECT_EQ(mesh.uv[0][mesh.triangles[1].y], glm::vec2(1, 1));
}

TEST_F(SceneGeometry, ZeroNormalsBecomeGeometricAndLongOnesUnit) {
  const int p = writer.floats(square, "VEC3");
  const int n = writer.floats({0, 0, 0, 0, 0, 7, 0, 0.5f, 0, 0, 0, 0}, "VEC3");
  const int i = writer.accessor(std::vector<std::uint16_t>{0, 1, 2, 1, 3, 2}, "SCALAR", test::type_ushort);
  writer.mesh_node({{"indices", i}, {"attributes", {{"POSITION", p}, {"NORMAL", n}}}});
  const Mesh mesh = load().meshes[0];
  for (const glm::vec3& normal : mesh.normals) EXPECT_NEAR(glm::length(normal), 1.0f, 1e-6f);
  expect_near(mesh.normals[mesh.triangles[0].x], {0, 0, 1}, 1e-6f);
  expect_near(mesh.normals[mesh.triangles[0].y], {0, 0, 1}, 1e-6f);
  expect_near(mesh.normals[mesh.triangles[0].z], {0, 1, 0}, 1e-6f);
  expect_near(mesh.normals[mesh.triangles[1].y], {0, 0, 1}, 1e-6f);
}

TEST_F(SceneGeometry, TrianglesWithoutAreaAreLeftOut) {
  const int p = writer.floats({0, 0, 0, 1, 0, 0, 0, 1, 0, 2, 0, 0, 0, 0, 0}, "VEC3");
  // good; collinear; two equal corners; two equal positions; good again: a duplicate
  const int i = writer.accessor(std::vector<std::uint16_t>{0, 1, 2, 0, 1, 3, 1, 1, 2, 0, 4, 2, 0, 1, 2}, "SCALAR",
                                test::type_ushort);
  writer.mesh_node({{"indices", i}, {"attributes", {{"POSITION", p}}}});
  ::testing::internal::CaptureStderr();
  EXPECT_EQ(load().triangle_count(), 1u);
  const std::string warnings = ::testing::internal::GetCapturedStderr();
  EXPECT_NE(warnings.find("3 triangles without area"), std::string::npos);
  EXPECT_NE(warnings.find("1 triangles lie exactly on others"), std::string::npos);
}

TEST_F(SceneGeometry, ZeroScaleDropsEverything) {
  writer.triangle({{"scale", {0.0, 0.0, 0.0}}});
  const Scene scene = load();
  EXPECT_EQ(scene.triangle_count(), 0u);
  EXPECT_EQ(scene.bounds_max, glm::vec3(0.0f));
}

TEST_F(SceneGeometry, TinyTrianglesStay) {
  writer.triangle({{"scale", {1e-6, 1e-6, 1e-6}}});
  EXPECT_EQ(load().triangle_count(), 1u);
}

TEST_F(SceneGeometry, TransformsComposeDownTheHierarchy) {
  const double h = std::sqrt(0.5);
  const int leaf = writer.triangle({{"scale", {2.0, 2.0, 2.0}}, {"translation", {1.0, 0.0, 0.0}}});
  // A quarter turn about Z, written as a matrix (columns) and as a quaternion, gives x -> y -> -x.
  const int matrix =
      writer.push("nodes", {{"children", {leaf}}, {"matrix", {0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 5, 1}}});
  writer.push("nodes", {{"children", {matrix}}, {"rotation", {0.0, 0.0, h, h}}});
  const Scene scene = load();
  ASSERT_EQ(scene.triangle_count(), 1u);
  expect_near(world(scene, 0), {-1, 0, 5}, 1e-5f);
  expect_near(world(scene, 1), {-3, 0, 5}, 1e-5f);
  expect_near(world(scene, 2), {-1, -2, 5}, 1e-5f);
}

TEST_F(SceneGeometry, MirroringKeepsTheFront) {
  const int p = writer.floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
  const int n = writer.floats({0.6f, 0, 0.8f, 0.6f, 0, 0.8f, 0.6f, 0, 0.8f}, "VEC3");
  writer.mesh_node({{"attributes", {{"POSITION", p}, {"NORMAL", n}}}}, {{"scale", {-1.0, 1.0, 1.0}}});
  writer.mesh_node({{"attributes", {{"POSITION", p}}}}, {{"scale", {-2.0, 1.0, 1.0}}});
  writer.mesh_node({{"attributes", {{"POSITION", p}}}}, {{"scale", {1.0, 1.0, -1.0}}});
  const Scene scene = load();
  expect_near(front(scene.meshes[0], 0), {0, 0, 1}, 1e-6f);
  expect_near(scene.meshes[0].normals[0], {-0.6f, 0, 0.8f}, 1e-6f);
  expect_near(scene.meshes[1].normals[0], {0, 0, 1}, 1e-6f);
  expect_near(front(scene.meshes[2], 0), {0, 0, -1}, 1e-6f);
  expect_near(scene.meshes[2].normals[0], {0, 0, -1}, 1e-6f);
}

TEST_F(SceneGeometry, NormalsTakeTheInverseTranspose) {
  const float h = std::sqrt(0.5f);
  const int p = writer.floats({0, 1, 0, 0, 1, 1, 1, 0, 0}, "VEC3");  // in the plane x + y = 1
  const int n = writer.floats({h, h, 0, h, h, 0, h, h, 0}, "VEC3");
  writer.mesh_node({{"attributes", {{"POSITION", p}, {"NORMAL", n}}}}, {{"scale", {4.0, 1.0, 1.0}}});
  const Mesh mesh = load().meshes[0];
  expect_near(mesh.normals[0], front(mesh, 0), 1e-6f);
  expect_near(mesh.normals[0], glm::normalize(glm::vec3(0.25f, 1, 0)), 1e-6f);
}

TEST_F(SceneGeometry, DefaultSceneFirstSceneOrAllRoots) {
  for (double x = 0; x < 3; ++x) writer.triangle({{"translation", {10.0 * x, 0.0, 0.0}}});
  EXPECT_EQ(load().triangle_count(), 3u);
  writer.root["scenes"] = {{{"nodes", {0}}}, {{"nodes", {1, 2}}}};
  EXPECT_EQ(load().triangle_count(), 1u);
  writer.root["scene"] = 1;
  const Scene scene = load();
  EXPECT_EQ(scene.triangle_count(), 2u);
  EXPECT_EQ(scene.meshes[0].object_id, 2u);
}

TEST_F(SceneGeometry, OffsetOfTheRootChangesNothing) {
  // Coordinates that floats cannot hold at 1e5 m.
  const int p =
      writer.floats({0.1234567f, 0.3333333f, -0.7777777f, 1.9876543f, 0.1f, 0.2f, 0.01f, 2.7182818f, 0.5f}, "VEC3");
  const int leaf = writer.mesh_node({{"attributes", {{"POSITION", p}}}}, {{"rotation", {0.1, 0.2, 0.3, 0.9}}});
  writer.root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
  const int light = writer.push(
      "nodes", {{"translation", {0.3, 0.2, 0.1}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  writer.root["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.7}, {"znear", 0.1}}}}};
  const int camera = writer.push("nodes", {{"translation", {0.0, 0.7, 3.3}}, {"camera", 0}});
  const int root = writer.push("nodes", {{"children", {leaf, light, camera}}});
  const Scene near = load();
  writer.root["nodes"][size_t(root)]["translation"] = {1e5, -1e5, 1e5};
  const Scene far = load();
  const float tolerance = 1e-6f * glm::length(near.bounds_max - near.bounds_min);
  EXPECT_LT(glm::distance(far.world_origin - near.world_origin, glm::dvec3(1e5, -1e5, 1e5)), 1e-6);
  for (size_t v = 0; v < 3; ++v) expect_near(far.meshes[0].positions[v], near.meshes[0].positions[v], tolerance);
  expect_near(far.lights[0].position, near.lights[0].position, tolerance);
  expect_near(far.cameras[0].world_from_camera[3], near.cameras[0].world_from_camera[3], tolerance);
}

}  // namespace
}  // namespace volgi
