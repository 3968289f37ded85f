#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "core/error.h"
#include "core/image.h"
#include "core/log.h"
#include "core/scene.h"
#include "core/surface.h"
#include "shaders/shared/material.shared.h"
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

class SceneMaterials : public ::testing::Test {
 protected:
  Scene load() { return load_scene(writer.save_glb(folder / "scene.glb")); }
  /// A triangle whose corner k has uv `corners[k]` in both sets, unless `second` is given.
  int textured_triangle(const std::vector<float>& corners, const std::vector<float>& second = {}) {
    const int p = writer.floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
    const int uv0 = writer.floats(corners, "VEC2");
    const int uv1 = second.empty() ? uv0 : writer.floats(second, "VEC2");
    return writer.mesh_node(
        {{"material", 0}, {"attributes", {{"POSITION", p}, {"TEXCOORD_0", uv0}, {"TEXCOORD_1", uv1}}}});
  }
  /// 2x2: red, green / blue, white with alpha 0; index of a texture on it.
  int texture(const Json& sampler = Json()) {
    const std::string bytes = test::png(2, 2, {255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 255, 255, 255, 0});
    const int view = writer.view(std::vector<char>(bytes.begin(), bytes.end()));
    Json t = {{"source", writer.push("images", {{"bufferView", view}, {"mimeType", "image/png"}})}};
    if (!sampler.is_null()) t["sampler"] = writer.push("samplers", sampler);
    return writer.push("textures", t);
  }
  Json& material(Json pbr = Json::object()) {
    if (!pbr.contains("metallicFactor")) pbr["metallicFactor"] = 0.0;
    writer.push("materials", {{"name", "paint"}, {"pbrMetallicRoughness", pbr}});
    writer.root["materials"].back()["extensions"]["KHR_materials_specular"]["specularFactor"] = 0;  // Lambertian
    return writer.root["materials"].back();
  }
  /// Of a surface whose dielectric part does not mirror.
  static glm::vec3 albedo_of(glm::vec3 base, float metallic, float roughness) {
    return shared::surface_albedo(shared::reflectance_of(base, metallic, glm::vec3(0.0f), 0.0f, 0), roughness);
  }
  static SurfacePoint corner(const Scene& scene, int k) {
    return surface_point(scene, scene.meshes[0], 0, k == 1 ? 1.0f : 0.0f, k == 2 ? 1.0f : 0.0f);
  }

  TemporaryFolder folder;
  GltfWriter writer;
};

constexpr Json::value_t no_sampler = Json::value_t::null;
const Json nearest = {{"magFilter", 9728}, {"minFilter", 9728}};

TEST_F(SceneMaterials, FactorsAndDefaults) {
  Json& m = material({{"baseColorFactor", {0.8, 0.6, 0.4, 0.5}}, {"metallicFactor", 0.25}});
  m["alphaMode"] = "MASK";
  m["alphaCutoff"] = 0.6;
  m["doubleSided"] = true;
  m["emissiveFactor"] = {1.0, 0.5, 0.0};
  m["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = 20;
  textured_triangle({0, 0, 0, 0, 0, 0});
  const Scene scene = load();
  const Material& read = scene.materials[0];
  EXPECT_EQ(read.name, "paint");
  EXPECT_EQ(read.alpha_mode, AlphaMode::mask);
  EXPECT_TRUE(read.double_sided);
  EXPECT_TRUE(read.is_emissive());
  const SurfacePoint point = corner(scene, 0);
  const glm::vec3 base(0.8f, 0.6f, 0.4f);
  expect_near(point.albedo, albedo_of(base, 0.25f, 1.0f));
  expect_near(point.emission, {20, 10, 0});
  EXPECT_EQ(point.alpha, 0.0f);  // 0.5 < 0.6
  expect_near(point.geometric_normal, {0, 0, 1});
}

TEST_F(SceneMaterials, AlphaModes) {
  Json& m = material({{"baseColorFactor", {1, 1, 1, 0.5}}});
  textured_triangle({0, 0, 0, 0, 0, 0});
  EXPECT_EQ(corner(load(), 0).alpha, 1.0f);
  m["alphaMode"] = "BLEND";
  EXPECT_EQ(corner(load(), 0).alpha, 0.5f);
  m["alphaMode"] = "MASK";  // cutoff 0.5 by default, inclusive
  EXPECT_EQ(corner(load(), 0).alpha, 1.0f);
}

/// A window of glass must not seal a room: what it lets pass is coverage that it has not, and what of it is not covered
/// anyway passes as well.
TEST_F(SceneMaterials, TransmissionIsAHole) {
  for (const auto& [mode, alpha, passes, covers] : {std::tuple("OPAQUE", 1.0, 1.0, 0.0f),
                                                    {"OPAQUE", 0.3, 0.75, 0.25f},
                                                    {"BLEND", 0.5, 0.5, 0.25f},
                                                    {"BLEND", 0.5, 0.0, 0.5f}}) {
    writer = GltfWriter();
    Json m = {{"name", "glass"}, {"alphaMode", mode}};
    m["pbrMetallicRoughness"] = {{"metallicFactor", 0.0}, {"baseColorFactor", {1.0, 1.0, 1.0, alpha}}};
    m["extensions"]["KHR_materials_transmission"]["transmissionFactor"] = passes;
    writer.push("materials", m);
    textured_triangle({0, 0, 0, 0, 0, 0});
    EXPECT_NEAR(corner(load(), 0).alpha, covers, 1e-6f) << mode << ' ' << passes;
  }
}

/// Dark glass darkens: light that passes has its colour; what is not transmitted keeps its reflectance.
TEST_F(SceneMaterials, ColouredGlassAbsorbs) {
  Json m = {{"name", "glass"}};
  m["pbrMetallicRoughness"] = {{"metallicFactor", 0.0}, {"baseColorFactor", {0.2, 0.2, 0.2, 1.0}}};
  m["extensions"]["KHR_materials_transmission"]["transmissionFactor"] = 0.75;
  m["extensions"]["KHR_materials_specular"]["specularFactor"] = 0;
  writer.push("materials", m);
  textured_triangle({0, 0, 0, 0, 0, 0});
  const SurfacePoint grey = corner(load(), 0);
  EXPECT_NEAR(grey.alpha, 0.25f, 1e-6f);
  expect_near(grey.tint, glm::vec3(0.2f));
  expect_near(grey.albedo, glm::vec3(0.2f));

  // Half covered, the other half passes without colour: 0.5 + 0.5 * 0.75 * 0.2 of all light.
  writer.root["materials"][0]["alphaMode"] = "BLEND";
  writer.root["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = {0.2, 0.2, 0.2, 0.5};
  const SurfacePoint half = corner(load(), 0);
  expect_near((1.0f - half.alpha) * half.tint, glm::vec3(0.575f));
  expect_near(half.albedo * half.alpha, glm::vec3(0.5f * 0.25f * 0.2f));

  writer.root["materials"][0]["alphaMode"] = "OPAQUE";
  writer.root["materials"][0]["pbrMetallicRoughness"]["metallicFactor"] = 1.0;  // a metal lets nothing pass
  EXPECT_EQ(corner(load(), 0).alpha, 1.0f);
}

/// Stained glass: light has the colour of the texel that it passes; the transmission texture's red channel says where
/// it is glass; the base colour's alpha is of no meaning in an opaque material.
TEST_F(SceneMaterials, TexturedGlass) {
  Json& m = material({{"baseColorTexture", {{"index", texture(nearest)}}}});
  m["extensions"]["KHR_materials_transmission"] = {{"transmissionFactor", 1.0}};
  const std::vector<float> red_green_white = {0.25f, 0.25f, 0.75f, 0.25f, 0.75f, 0.75f};
  textured_triangle(red_green_white);
  const Scene colored = load();
  const std::array<glm::vec3, 3> colours{glm::vec3(1, 0, 0), {0, 1, 0}, {1, 1, 1}};
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(corner(colored, int(i)).alpha, 0.0f);
    expect_near(corner(colored, int(i)).tint, colours[i], 0.003f);
  }

  Json& transmission = writer.root["materials"][0]["extensions"]["KHR_materials_transmission"];
  transmission["transmissionTexture"]["index"] = 0;  // red at the red and the white texel, none at the green one
  const Scene partly = load();
  EXPECT_EQ(corner(partly, 0).alpha, 0.0f);
  EXPECT_EQ(corner(partly, 1).alpha, 1.0f);
  expect_near(corner(partly, 1).albedo, {0, 1, 0}, 0.003f);

  writer.root["materials"][0]["pbrMetallicRoughness"].erase("baseColorTexture");
  const Scene clear = load();
  EXPECT_EQ(corner(clear, 0).alpha, 0.0f);
  EXPECT_EQ(corner(clear, 1).alpha, 1.0f);
  expect_near(corner(clear, 1).albedo, {1, 1, 1});
}

TEST_F(SceneMaterials, SpecularAndRefractiveIndex) {
  material().erase("extensions");
  textured_triangle({0, 0, 0, 0, 0, 0});
  const Material defaults = load().materials[0];
  EXPECT_EQ(defaults.specular_factor, 1.0f);
  EXPECT_EQ(defaults.specular_color_factor, glm::vec3(1.0f));
  EXPECT_EQ(defaults.ior, 1.5f);

  Json& extensions = writer.root["materials"][0]["extensions"];
  extensions["KHR_materials_specular"] = {{"specularFactor", 0}, {"specularColorFactor", {0.5, 0, 2}}};
  extensions["KHR_materials_ior"]["ior"] = 1.33;
  writer.root["extensionsUsed"] = {"KHR_materials_specular", "KHR_materials_ior"};
  writer.root["extensionsRequired"] = writer.root["extensionsUsed"];
  ::testing::internal::CaptureStderr();
  const Material read = load().materials[0];
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(read.specular_factor, 0.0f);
  EXPECT_EQ(read.specular_color_factor, glm::vec3(0.5f, 0.0f, 2.0f));
  EXPECT_EQ(read.ior, 1.33f);
  extensions["KHR_materials_ior"]["ior"] = 0;
  EXPECT_EQ(load().materials[0].ior, 0.0f);
}

TEST_F(SceneMaterials, SpecularTexturesAreIgnored) {
  material()["extensions"]["KHR_materials_specular"] = {{"specularTexture", {{"index", 0}}},
                                                        {"specularColorTexture", {{"index", 0}}}};
  textured_triangle({0, 0, 0, 0, 0, 0});
  ::testing::internal::CaptureStderr();
  EXPECT_TRUE(load().textures.empty());
  const std::string warning = ::testing::internal::GetCapturedStderr();
  const size_t first = warning.find("specular textures");
  ASSERT_NE(first, std::string::npos) << warning;
  EXPECT_EQ(warning.find("specular textures", first + 1), std::string::npos) << warning;
}

/// Every other viewer shows what leaves out metallicFactor: it reflects what such a metal does, and says how.
TEST_F(SceneMaterials, DefaultMetalReflectsDiffuselyAndSaysSo) {
  writer.push("materials", {{"name", "chrome"}});
  textured_triangle({0, 0, 0, 0, 0, 0});
  ::testing::internal::CaptureStderr();
  const Scene scene = load();
  expect_near(corner(scene, 0).albedo, albedo_of(glm::vec3(1.0f), 1.0f, 1.0f));
  EXPECT_NEAR(largest_albedo(scene), corner(scene, 0).albedo.x, 1e-6f);
  const std::string warning = ::testing::internal::GetCapturedStderr();
  EXPECT_NE(warning.find("chrome"), std::string::npos) << warning;
}

TEST_F(SceneMaterials, VertexColourMultipliesTheAlbedo) {
  material({{"baseColorFactor", {0.5, 1, 1, 1}}});
  const int p = writer.floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
  const int c = writer.floats({1, 0, 0, 0, 1, 0, 0, 0, 1}, "VEC3");
  writer.mesh_node({{"material", 0}, {"attributes", {{"POSITION", p}, {"COLOR_0", c}}}});
  const Scene scene = load();
  expect_near(surface_point(scene, scene.meshes[0], 0, 0.25f, 0.25f).albedo, {0.25f, 0.25f, 0.25f});
  EXPECT_FLOAT_EQ(largest_albedo(scene), 1.0f);
}

TEST_F(SceneMaterials, NearestTexelsOfEmbeddedExternalAndDataUriImages) {
  material({{"baseColorTexture", {{"index", texture(nearest)}}}});
  textured_triangle({0.25f, 0.25f, 0.75f, 0.25f, 0.25f, 0.75f});
  const auto check = [&](const Scene& scene) {
    expect_near(corner(scene, 0).albedo, {1, 0, 0});
    expect_near(corner(scene, 1).albedo, {0, 1, 0});
    expect_near(corner(scene, 2).albedo, {0, 0, 1});
  };
  check(load());
  const std::string bytes = test::png(2, 2, {255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 255, 255, 255, 0});
  std::filesystem::create_directory(folder / "tex");
  test::write_bytes(folder / "tex/a b.png", bytes);
  writer.root["images"][0] = {{"uri", "tex/a%20b.png"}};
  check(load());
  check(load_scene(writer.save_gltf(folder / "scene.gltf")));
  writer.root["images"][0] = {{"uri", "data:image/png;base64," + test::base64(bytes)}};
  check(load());
}

TEST_F(SceneMaterials, BilinearFilteringDecodesFirst) {
  material({{"baseColorTexture", {{"index", texture(Json{{"wrapS", 33071}, {"wrapT", 33071}})}}}});
  textured_triangle({0.5f, 0.25f, 0.5f, 0.5f, 0, 0});
  const Scene scene = load();
  expect_near(corner(scene, 0).albedo, {0.5f, 0.5f, 0});  // linear mean of red and green
  expect_near(corner(scene, 1).albedo, {0.5f, 0.5f, 0.5f});
  expect_near(corner(scene, 2).albedo, {1, 0, 0});
}

TEST_F(SceneMaterials, SrgbIsDecodedForColourAndNotForMetal) {
  const std::string bytes = test::png(1, 1, {128, 128, 128, 255});
  writer.push("images", {{"uri", "data:image/png;base64," + test::base64(bytes)}});
  writer.push("textures", {{"source", 0}});
  const Json use = {{"index", 0}};
  Json& m = material({{"baseColorTexture", use}, {"metallicRoughnessTexture", use}, {"metallicFactor", 0.5}});
  m["emissiveTexture"] = use;
  m["emissiveFactor"] = {2, 2, 2};
  textured_triangle({0, 0, 0, 0, 0, 0});
  const Scene scene = load();
  const float linear = srgb_decode(128.0f / 255.0f);
  const float texel = 128.0f / 255.0f;
  const glm::vec3 base(linear);
  expect_near(corner(scene, 0).albedo, albedo_of(base, 0.5f * texel, texel));
  expect_near(corner(scene, 0).emission, glm::vec3(2.0f * linear));
  EXPECT_NEAR(largest_albedo(scene), corner(scene, 0).albedo.x, 1e-6f);
  EXPECT_EQ(scene.images.size(), 1u);
}

TEST_F(SceneMaterials, MetallicIsTheBlueChannelAndRoughnessTheGreen) {
  const std::string bytes = test::png(1, 1, {10, 20, 51, 255});
  writer.push("images", {{"uri", "data:image/png;base64," + test::base64(bytes)}});
  writer.push("textures", {{"source", 0}});
  material({{"metallicRoughnessTexture", {{"index", 0}}}, {"metallicFactor", 1.0}, {"roughnessFactor", 0.5}});
  textured_triangle({0, 0, 0, 0, 0, 0});
  expect_near(corner(load(), 0).albedo, albedo_of(glm::vec3(1.0f), 0.2f, 0.5f * 20.0f / 255.0f));
}

TEST_F(SceneMaterials, WrapModes) {
  const struct {
    int mode;
    std::vector<glm::vec3> expected;  // at u = -0.25, 1.25, 2.25 with v = 0.25
  } cases[] = {{10497, {{0, 1, 0}, {1, 0, 0}, {1, 0, 0}}},
               {33648, {{1, 0, 0}, {0, 1, 0}, {1, 0, 0}}},
               {33071, {{1, 0, 0}, {0, 1, 0}, {0, 1, 0}}}};
  for (const auto& c : cases) {
    writer = GltfWriter();
    Json sampler = nearest;
    sampler["wrapS"] = c.mode;
    material({{"baseColorTexture", {{"index", texture(sampler)}}}});
    textured_triangle({-0.25f, 0.25f, 1.25f, 0.25f, 2.25f, 0.25f});
    const Scene scene = load();
    for (int k = 0; k < 3; ++k) expect_near(corner(scene, k).albedo, c.expected[size_t(k)]);
  }
}

TEST_F(SceneMaterials, BilinearNeighboursWrapAcrossTheEdge) {
  material({{"baseColorTexture", {{"index", texture(Json::object())}}}});
  textured_triangle({0.0f, 0.25f, 1.0f, 0.25f, -7.0f, 0.25f});
  const Scene scene = load();
  for (int k = 0; k < 3; ++k) expect_near(corner(scene, k).albedo, {0.5f, 0.5f, 0});
}

TEST_F(SceneMaterials, AbsurdTextureCoordinatesAreHarmless) {
  material({{"baseColorTexture", {{"index", texture(Json::object())}}}});
  textured_triangle({3e38f, -3e38f, 1e20f, 1e-40f, -1e-30f, 1e30f});
  const Scene scene = load();
  for (const float u : {0.0f, 0.3f, 1.0f}) {
    EXPECT_TRUE(std::isfinite(surface_point(scene, scene.meshes[0], 0, u, 0.0f).albedo.x));
  }
  EXPECT_TRUE(std::isfinite(sample_texture(scene, 0, {std::nanf(""), INFINITY}, true).x));
}

TEST_F(SceneMaterials, SecondTextureCoordinates) {
  material({{"baseColorTexture", {{"index", texture(nearest)}, {"texCoord", 1}}}});
  textured_triangle({0.25f, 0.25f, 0.25f, 0.25f, 0.25f, 0.25f}, {0.75f, 0.25f, 0.25f, 0.75f, 0.75f, 0.25f});
  const Scene scene = load();
  expect_near(corner(scene, 0).albedo, {0, 1, 0});
  expect_near(corner(scene, 1).albedo, {0, 0, 1});
}

TEST_F(SceneMaterials, TextureTransform) {
  // The extension's own example: the lower left quadrant of the image, turned by a quarter.
  const Json transform = {
      {"offset", {0, 1}}, {"rotation", glm::half_pi<double>()}, {"scale", {0.5, 0.5}}, {"texCoord", 1}};
  material(
      {{"baseColorTexture", {{"index", texture(nearest)}, {"extensions", {{"KHR_texture_transform", transform}}}}}});
  textured_triangle({0, 0, 0, 0, 0, 0}, {0.1f, 0.1f, 0.9f, 0.1f, 0.1f, 0.9f});
  const Scene scene = load();
  const TextureUse& use = scene.materials[0].base_color;
  EXPECT_EQ(use.texcoord, 1);
  const auto transformed = [&](float u, float v) { return glm::vec2(use.uv_from_texcoord * glm::vec3(u, v, 1)); };
  for (const glm::vec2 uv : {transformed(0.1f, 0.1f), transformed(0.9f, 0.1f), transformed(0.1f, 0.9f)}) {
    EXPECT_GT(uv.x, 0.0f);
    EXPECT_LT(uv.x, 0.5f);
    EXPECT_GT(uv.y, 0.5f);
    EXPECT_LT(uv.y, 1.0f);
  }
  EXPECT_LT(glm::distance(transformed(1, 0), glm::vec2(0, 0.5f)), 1e-6f);
  EXPECT_LT(glm::distance(transformed(0, 1), glm::vec2(0.5f, 1)), 1e-6f);
  expect_near(corner(scene, 0).albedo, {0, 0, 1});
}

TEST_F(SceneMaterials, SamplerModes) {
  const struct {
    int min, mag;
    bool minify_nearest, magnify_nearest, mipmap, mipmap_nearest;
  } cases[] = {{9728, 9728, true, true, false, false}, {9729, 9729, false, false, false, false},
               {9984, 9729, true, false, true, true},  {9985, 9729, false, false, true, true},
               {9986, 9729, true, false, true, false}, {9987, 9729, false, false, true, false}};
  Json& m = material();
  for (const auto& c : cases) {
    m["pbrMetallicRoughness"]["baseColorTexture"]["index"] = texture(Json{{"minFilter", c.min}, {"magFilter", c.mag}});
    const Sampler s = load().textures[0].sampler;
    EXPECT_EQ(s.minify_nearest, c.minify_nearest) << c.min;
    EXPECT_EQ(s.magnify_nearest, c.magnify_nearest) << c.min;
    EXPECT_EQ(s.mipmap, c.mipmap) << c.min;
    EXPECT_EQ(s.mipmap_nearest, c.mipmap_nearest) << c.min;
  }
  m["pbrMetallicRoughness"]["baseColorTexture"]["index"] = texture(Json(no_sampler));
  EXPECT_TRUE(load().textures[0].sampler.mipmap);
}

TEST_F(SceneMaterials, UnusedImagesAreNotDecoded) {
  writer.push("images", {{"uri", "data:image/png;base64," + test::base64("not a picture")}});
  writer.push("textures", {{"source", 0}});
  material()["occlusionTexture"] = {{"index", 0}};
  EXPECT_TRUE(load().images.empty());
}

// What only changes a surface's look need not be understood, also where a file says that it must.
TEST_F(SceneMaterials, RequiredCosmeticExtensionsAreWarnedAbout) {
  material();
  textured_triangle({0, 0, 0, 0, 0, 0});
  for (const char* name : {"KHR_materials_variants", "KHR_materials_clearcoat", "KHR_xmp_json_ld"}) {
    writer.root["extensionsRequired"] = {name};
    ::testing::internal::CaptureStderr();
    EXPECT_EQ(load().materials.size(), 1u) << name;
    EXPECT_NE(::testing::internal::GetCapturedStderr().find(name), std::string::npos);
  }
  writer.root["extensionsRequired"] = {"VENDOR_new_geometry"};
  EXPECT_THROW(load(), Error);
}

TEST_F(SceneMaterials, UnlitIsSeenAndSendsNothing) {
  Json& m = material({{"baseColorFactor", {0.8, 0.6, 0.4, 1}}});
  m["emissiveFactor"] = {1, 1, 1};
  m["extensions"]["KHR_materials_unlit"] = Json::object();
  writer.root["extensionsRequired"] = {"KHR_materials_unlit"};
  textured_triangle({0, 0, 0, 0, 0, 0});
  const Scene scene = load();
  const SurfacePoint point = corner(scene, 0);
  expect_near(point.unlit, {0.8f, 0.6f, 0.4f});
  expect_near(point.albedo, glm::vec3(0.0f));
  expect_near(point.emission, glm::vec3(0.0f));
  EXPECT_FALSE(scene.materials[0].is_emissive());
  EXPECT_EQ(largest_albedo(scene), 0.0f);
}

TEST_F(SceneMaterials, SpecularGlossinessIsADielectricOfItsDiffuseColour) {
  Json& m = material({{"baseColorFactor", {0, 0, 0, 1}}});
  m["extensions"] = {{"KHR_materials_pbrSpecularGlossiness",
                      {{"diffuseFactor", {0.5, 0.25, 0.125, 0.75}},
                       {"glossinessFactor", 0.25},
                       {"specularFactor", {0.02, 0.04, 0.08}}}}};
  textured_triangle({0, 0, 0, 0, 0, 0});
  const Material read = load().materials[0];
  EXPECT_EQ(read.base_color_factor, glm::vec4(0.5f, 0.25f, 0.125f, 0.75f));
  EXPECT_EQ(read.metallic_factor, 0.0f);
  EXPECT_FLOAT_EQ(read.roughness_factor, 0.75f);
  expect_near(read.dielectric_0(), {0.02f, 0.04f, 0.08f});
  m["extensions"]["KHR_materials_pbrSpecularGlossiness"]["diffuseFactor"] = {2, 0, 0, 1};
  EXPECT_EQ(load().materials[0].base_color_factor, glm::vec4(1, 0, 0, 1));
}

// A map that leans towards +U and up the picture: on a triangle whose U runs along +X and whose V, downwards, along -Y.
TEST_F(SceneMaterials, NormalMapLeansAlongItsPicture) {
  const std::string bytes = test::png(1, 1, {204, 153, 230, 255});
  writer.push("images", {{"uri", "data:image/png;base64," + test::base64(bytes)}});
  writer.push("textures", {{"source", 0}});
  material()["normalTexture"] = {{"index", 0}, {"scale", 0.5}};
  textured_triangle({0, 1, 1, 1, 0, 0});
  const glm::vec3 texel = glm::vec3(204, 153, 230) / 127.5f - 1.0f;
  expect_near(corner(load(), 0).shading_normal, glm::normalize(glm::vec3(0.5f * texel.x, 0.5f * texel.y, texel.z)));
  writer.root["meshes"].clear();
  writer.root["nodes"].clear();
  textured_triangle({1, 1, 0, 1, 1, 0});  // mirrored in U
  expect_near(corner(load(), 0).shading_normal, glm::normalize(glm::vec3(-0.5f * texel.x, 0.5f * texel.y, texel.z)));
}

TEST_F(SceneMaterials, IgnoredFeaturesAreWarnedAboutOnce) {
  writer.root["extensionsUsed"] = {"KHR_materials_clearcoat"};
  material()["extensions"]["KHR_materials_clearcoat"] = Json::object();
  const int p = writer.floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
  writer.mesh_node({{"material", 0}, {"attributes", {{"POSITION", p}}}});
  writer.mesh_node({{"mode", 0}, {"material", 0}, {"attributes", {{"POSITION", p}}}});
  writer.mesh_node({{"mode", 1}, {"material", 0}, {"attributes", {{"POSITION", p}}}});
  ::testing::internal::CaptureStderr();
  load();
  load();
  const std::string warnings = ::testing::internal::GetCapturedStderr();
  for (const char* text : {"KHR_materials_clearcoat", "points and lines"}) {
    const size_t first = warnings.find(text);
    ASSERT_NE(first, std::string::npos) << text;
    EXPECT_EQ(warnings.find(text, first + 1), std::string::npos) << text;
  }
}

TEST_F(SceneMaterials, QuietSilencesWarnings) {
  writer.push("materials", {{"name", "quiet metal"}});
  set_quiet(true);
  ::testing::internal::CaptureStderr();
  load();
  set_quiet(false);
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST(Surface, ShadingNormalIsUnitAndOnTheFrontSide) {
  Scene scene;
  scene.materials.emplace_back();
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.normals = {{0, 0, -1}, {0.6f, 0, -0.8f}, {0, 0, -1}};
  mesh.triangles = {{0, 1, 2}};
  scene.meshes.push_back(mesh);
  const SurfacePoint point = surface_point(scene, scene.meshes[0], 0, 0.5f, 0.25f);
  expect_near(point.position, {0.5f, 0.25f, 0});
  EXPECT_NEAR(glm::length(point.shading_normal), 1.0f, 1e-6f);
  EXPECT_GT(point.shading_normal.z, 0.0f);
}

}  // namespace
}  // namespace volgi
