// Materials in the raster and shadow passes: textures, alpha, emission.
#include <algorithm>
#include <cmath>

#include "tests/screen/ray_truth.h"
#include "tests/screen/screen_scene.h"
#include "tests/support/gl_test.h"

namespace volgi::test {
namespace {

constexpr glm::ivec2 size(128);

/// Pseudo-random texels, always the same.
TextureImage noise_image(int width, int height) {
  TextureImage image{width, height, {}};
  std::uint32_t state = 1;
  for (int i = 0; i < 4 * width * height; ++i) {
    state = state * 1664525u + 1013904223u;
    image.rgba.edit().push_back(std::uint8_t(state >> 24));
  }
  return image;
}

/// Adds the image with a sampler as a texture; returns its index.
int add_texture(Scene& scene, TextureImage image, const Sampler& sampler) {
  scene.images.push_back(std::move(image));
  scene.textures.push_back({int(scene.images.size()) - 1, sampler});
  return int(scene.textures.size()) - 1;
}

/// A quad from (-1,-1) to (1,1) at the given height, front side up.
Mesh& add_ground(Scene& scene, int material, float height) {
  return add_quad(scene, material, {-1, height, -1}, {0, 0, 2}, {2, 0, 0});
}

Camera camera_above(const Scene& scene) {
  return look_at_camera({0.3f, 2.4f, 0.9f}, {0, 0, 0}, 0.7f, scene.bounds_min, scene.bounds_max);
}

using Material = GlTest;

// sRGB decoding, wrap modes, both texture coordinate sets, KHR_texture_transform, metal, vertex colour: as on the CPU.
TEST_F(Material, TexturesAgreeWithTheCpu) {
  for (const Wrap wrap : {Wrap::repeat, Wrap::mirrored_repeat, Wrap::clamp_to_edge}) {
    for (const bool nearest : {false, true}) {
      Scene scene;
      const int material = add_material(scene, {0.9f, 0.8f, 0.7f});
      Mesh& mesh = add_ground(scene, material, 0.0f);
      mesh.colors = {glm::vec4(1.0f), {1, 0.5f, 1, 1}, glm::vec4(0.9f), {0.2f, 1, 1, 1}};
      for (const glm::vec2 uv : mesh.uv[0]) mesh.uv[1].push_back(0.5f * uv + 0.1f);
      const Sampler sampler{wrap, Wrap::repeat, nearest, nearest, true, false};
      auto& m = scene.materials[size_t(material)];
      const glm::mat3 turned(1.2f, 0.7f, 0.0f, -0.7f, 1.2f, 0.0f, -0.3f, 0.2f, 1.0f);
      m.base_color = {add_texture(scene, noise_image(5, 3), sampler), 0, turned};
      m.metallic = {add_texture(scene, noise_image(4, 4), sampler), 1, glm::mat3(1.0f)};
      m.metallic_factor = 0.5f;
      update_bounds(scene);
      const Camera camera = camera_above(scene);
      const Image albedo = render_direct(context(), scene, camera, size).albedo;
      const TruePicture truth = true_picture(scene, camera, size);
      int checked = 0;
      int wrong = 0;
      for (int y = 0; y < size.y; ++y) {
        for (int x = 0; x < size.x; ++x) {
          if (!truth.smooth_around(x, y, 1) || !truth.at(x, y).hit) continue;
          ++checked;
          const glm::vec3 d = glm::abs(albedo.at(x, y) - truth.at(x, y).point.albedo);
          wrong += std::max({d.x, d.y, d.z}) > 0.01f;  // GL filters with 8 bits of fraction
        }
      }
      EXPECT_GT(checked, 5000);
      // Nearest: the texel's border may fall between the two roundings of a coordinate.
      EXPECT_LE(wrong, nearest ? checked / 200 : 0) << "wrap " << int(wrap) << (nearest ? " nearest" : " linear");
    }
  }
}

TEST_F(Material, FactorsAreLinearAndTexturesAreSrgb) {
  Scene scene;
  const int material = add_material(scene, glm::vec3(0.5f));
  add_ground(scene, material, 0.0f);
  scene.materials[0].base_color.texture = add_texture(scene, {1, 1, {188, 188, 188, 255}}, {});
  update_bounds(scene);
  const float expected = 0.5f * 0.50289f;  // ((188/255 + 0.055) / 1.055)^2.4; llvmpipe's polynomial is 0.0007 off
  EXPECT_NEAR(render_direct(context(), scene, camera_above(scene), size).albedo.at(64, 64).g, expected, 5e-4f);
}

TEST_F(Material, MaskCutsRasterAndShadow) {
  Scene scene;
  const int ground = add_material(scene, glm::vec3(0.6f));
  const int grid = add_material(scene, glm::vec3(0.8f));
  add_ground(scene, ground, 0.0f);
  Mesh& sieve = add_ground(scene, grid, 0.5f);
  for (glm::vec3& p : sieve.positions) p *= glm::vec3(0.5f, 1.0f, 0.5f);
  TextureImage checker{4, 4, {}};
  for (int i = 0; i < 16; ++i) {
    for (const int value : {255, 255, 255, (i + i / 4) % 2 == 0 ? 255 : 90})
      checker.rgba.edit().push_back(std::uint8_t(value));
  }
  Sampler nearest;
  nearest.magnify_nearest = nearest.minify_nearest = true;
  nearest.mipmap = false;
  scene.materials[size_t(grid)].base_color.texture = add_texture(scene, checker, nearest);
  scene.materials[size_t(grid)].alpha_mode = AlphaMode::mask;
  update_bounds(scene);
  scene.lights = {point_light({0.4f, 1.8f, -0.3f}, 5.0f)};
  const Camera camera = camera_above(scene);
  const Image image = render_direct(context(), scene, camera, size).radiance;
  const TruePicture truth = true_picture(scene, camera, size);
  int seen_through = 0;
  int shadow = 0;
  int wrong = 0;
  for (int y = 0; y < size.y; ++y) {
    for (int x = 0; x < size.x; ++x) {
      const TruePixel& p = truth.at(x, y);
      if (!p.hit || !truth.smooth_around(x, y, 2)) continue;
      const bool in_square = std::max(std::abs(p.point.position.x), std::abs(p.point.position.z)) < 0.5f;
      seen_through += p.mesh == 0 && in_square;
      shadow += p.lit == 0;
      wrong += std::abs(image.at(x, y).g - p.radiance.g) > 0.005 * std::max(p.radiance.g, 1e-6);
    }
  }
  EXPECT_GT(seen_through, 200);
  EXPECT_GT(shadow, 200);
  EXPECT_EQ(wrong, 0);
}

// Coverage α hides α of what is behind it, and α of the light, on average; two layers do so independently.
TEST_F(Material, BlendCoversByChance) {
  constexpr float alpha = 0.3f;
  Scene scene;
  const int ground = add_material(scene, glm::vec3(0.6f));
  const int veil = add_material(scene, glm::vec3(0.0f));
  scene.materials[size_t(veil)].alpha_mode = AlphaMode::blend;
  scene.materials[size_t(veil)].base_color_factor.a = alpha;
  add_ground(scene, ground, 0.0f);
  add_ground(scene, veil, 0.5f);
  add_ground(scene, veil, 0.6f);
  update_bounds(scene);
  scene.lights = {sun_light({0, -1, 0}, 3.0f)};
  const Camera above = look_at_camera({0, 3, 0.01f}, {0, 0, 0}, 0.3f, scene.bounds_min, scene.bounds_max);
  const DirectPicture picture = render_direct(context(), scene, above, size);
  double lit = 0.0;
  double ground_pixels = 0.0;
  for (size_t i = 0; i < picture.object_id.size(); ++i) {
    if (picture.object_id[i] != 1.0f) continue;
    ground_pixels += 1.0;
    lit += double(picture.radiance.pixels[i].r);
  }
  const double through = (1.0 - alpha) * (1.0 - alpha);
  EXPECT_NEAR(ground_pixels / double(picture.object_id.size()), through, 0.02);
  EXPECT_NEAR(lit / ground_pixels / (0.6 / glm::pi<double>() * 3.0), through, 0.02);
}

TEST_F(Material, EmissionLeavesTheFrontUnlessDoubleSided) {
  Scene scene;
  const int lamp = add_material(scene, glm::vec3(0.0f));
  scene.materials[size_t(lamp)].emissive_radiance = {1e5f, 3.0f, 0.25f};
  add_ground(scene, lamp, 0.0f);
  update_bounds(scene);
  const Camera above = camera_above(scene);
  const Camera below = look_at_camera({0, -2, 0.1f}, {0, 0, 0}, 0.5f, scene.bounds_min, scene.bounds_max);
  const auto middle = [&](const Camera& c) { return render_direct(context(), scene, c, size).emission.at(64, 64); };
  EXPECT_EQ(middle(above), glm::vec3(1e5f, 3.0f, 0.25f));
  EXPECT_EQ(middle(below), glm::vec3(0.0f));
  scene.materials[size_t(lamp)].double_sided = true;
  EXPECT_EQ(middle(below), glm::vec3(1e5f, 3.0f, 0.25f));
}

}  // namespace
}  // namespace volgi::test
