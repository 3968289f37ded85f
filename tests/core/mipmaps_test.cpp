#include <gtest/gtest.h>

#include "core/image.h"
#include "core/mipmaps.h"
#include "core/surface.h"

namespace volgi::test {
namespace {

/// Red rises along x, green along y, in linear light but for rounding to 8 bits; blue is a checkerboard of 0 and 255.
TextureImage ramp(int width, int height) {
  TextureImage image{width, height, {}};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      image.rgba.edit().push_back(std::uint8_t(255 * (2 * x + 1) / (2 * width)));
      image.rgba.edit().push_back(std::uint8_t(255 * (2 * y + 1) / (2 * height)));
      image.rgba.edit().push_back((x + y) % 2 == 0 ? 255 : 0);
      image.rgba.edit().push_back(255);
    }
  }
  return image;
}

Scene textured(const TextureImage& image, Sampler sampler) {
  Scene scene;
  scene.images.push_back(image);
  scene.textures.push_back({0, sampler});
  return scene;
}

TEST(MipChain, HalvesDownToOneTexel) {
  const auto chain = mip_chain(ramp(8, 4), false);
  ASSERT_EQ(chain.size(), 4u);
  const int edges[][2] = {{8, 4}, {4, 2}, {2, 1}, {1, 1}};
  for (size_t k = 0; k < chain.size(); ++k) {
    EXPECT_EQ(chain[k].width, edges[k][0]);
    EXPECT_EQ(chain[k].height, edges[k][1]);
    EXPECT_EQ(chain[k].texels.size(), size_t(edges[k][0] * edges[k][1]));
  }
}

TEST(MipChain, KeepsTheMeanAndThePlaceOfEveryTexel) {
  const auto chain = mip_chain(ramp(16, 16), false);
  for (size_t k = 1; k < chain.size(); ++k) {
    const int n = chain[k].width;
    for (int y = 0; y < n; ++y) {
      for (int x = 0; x < n; ++x) {
        const glm::vec4 t = chain[k].texels[size_t(y) * size_t(n) + size_t(x)];
        EXPECT_NEAR(t.x, (float(x) + 0.5f) / float(n), 0.004f);  // a ramp stays where it is; 8 bits
        EXPECT_NEAR(t.y, (float(y) + 0.5f) / float(n), 0.004f);
        EXPECT_NEAR(t.z, 0.5f, 1e-6f);
      }
    }
  }
}

TEST(MipChain, FiltersLightNotItsEncoding) {
  EXPECT_NEAR(mip_chain(ramp(2, 2), true).back().texels[0].z, 0.5f, 1e-6f);
  TextureImage grey{2, 1, {188, 188, 188, 255, 0, 0, 0, 255}};
  EXPECT_NEAR(mip_chain(grey, true).back().texels[0].x, 0.5f * srgb_decode(188.0f / 255.0f), 1e-6f);
}

TEST(MipChain, OddEdgesKeepTheMeanOfARamp) {
  const auto chain = mip_chain(ramp(5, 3), false);
  ASSERT_EQ(chain[1].width, 2);
  ASSERT_EQ(chain[1].height, 1);
  EXPECT_NEAR(0.5f * (chain[1].texels[0].x + chain[1].texels[1].x), 0.5f, 0.004f);
  EXPECT_NEAR(chain[2].texels[0].y, 0.5f, 0.004f);
}

TEST(Mipmaps, SampleBetweenLevels) {
  const Scene scene = textured(ramp(16, 16), {});
  Mipmaps mipmaps(scene);
  mipmaps.prepare(0, false);
  const glm::vec2 uv(0.53f, 0.41f);
  const auto chain = mip_chain(scene.images[0], false);
  EXPECT_EQ(mipmaps.sample(0, uv, 0.0f, false), sample_texture(scene, 0, uv, false));
  EXPECT_EQ(mipmaps.sample(0, uv, -3.0f, false), sample_texture(scene, 0, uv, false));
  EXPECT_EQ(mipmaps.sample(0, uv, 99.0f, false), chain.back().texels[0]);
  const glm::vec4 one = mipmaps.sample(0, uv, 1.0f, false), two = mipmaps.sample(0, uv, 2.0f, false);
  EXPECT_NEAR(one.x, uv.x, 0.004f);
  for (int c = 0; c < 4; ++c) {
    EXPECT_NEAR(mipmaps.sample(0, uv, 1.25f, false)[c], 0.75f * one[c] + 0.25f * two[c], 1e-6f);
  }
}

TEST(Mipmaps, FollowTheSampler) {
  Sampler nearest;
  nearest.minify_nearest = true;
  nearest.mipmap_nearest = true;
  const Scene scene = textured(ramp(16, 16), nearest);
  Mipmaps mipmaps(scene);
  mipmaps.prepare(0, false);
  const auto chain = mip_chain(scene.images[0], false);
  EXPECT_EQ(mipmaps.sample(0, {0.6f, 0.1f}, 1.3f, false), chain[1].texels[4]);   // (4, 0) of 8 x 8
  EXPECT_EQ(mipmaps.sample(0, {-0.4f, 1.1f}, 1.3f, false), chain[1].texels[4]);  // repeats
  Sampler flat;
  flat.mipmap = false;
  const Scene other = textured(ramp(16, 16), flat);
  Mipmaps none(other);
  none.prepare(0, false);
  EXPECT_EQ(none.sample(0, {0.6f, 0.1f}, 3.0f, false), sample_texture(other, 0, {0.6f, 0.1f}, false));
}

}  // namespace
}  // namespace volgi::test
