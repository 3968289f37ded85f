// The mean of pictures, from reset() on.
#include "screen/display/accumulate.h"

#include <limits>
#include <random>

#include "tests/screen/display_target.h"
#include "tests/support/gl_test.h"

namespace volgi::test {
namespace {

using Accumulate = GlTest;

TEST_F(Accumulate, IsTheMeanSinceReset) {
  constexpr glm::ivec2 size(13, 9);
  constexpr int pictures = 100;
  std::mt19937 random(3);
  std::uniform_real_distribution<float> value(0.5f, 1.5f);
  gl::PassTimer timer(context().software(), false);
  screen::Accumulate accumulate(size);
  const gl::Texture broken = rgba_texture(
      GL_RGBA32F, size, std::vector<glm::vec4>(13 * 9, glm::vec4(std::numeric_limits<float>::quiet_NaN())));
  accumulate.add(broken, timer);
  accumulate.reset();  // forgets what is not finite, too
  EXPECT_EQ(accumulate.count(), 0);
  std::vector<glm::dvec4> sum(size_t(size.x * size.y), glm::dvec4(0.0));
  for (int k = 0; k < pictures; ++k) {
    std::vector<glm::vec4> radiance;
    for (glm::dvec4& s : sum) {
      radiance.push_back(1e4f * glm::vec4(value(random), value(random), value(random), value(random)));
      s += glm::dvec4(radiance.back());
    }
    accumulate.add(rgba_texture(GL_RGBA32F, size, radiance), timer);
  }
  EXPECT_EQ(accumulate.count(), pictures);
  const std::vector<float> mean = accumulate.mean().download(4);
  for (size_t i = 0; i < mean.size(); ++i) {
    const double expected = sum[i / 4][int(i % 4)] / pictures;
    EXPECT_NEAR(double(mean[i]) / expected, 1.0, 1e-6);  // 2^-24 sqrt(100 / 3) is a third of it
  }
}

TEST_F(Accumulate, OneOfOneIsExact) {
  gl::PassTimer timer(context().software(), false);
  screen::Accumulate accumulate({1, 1});
  const std::vector<glm::vec4> texel{{1e-30f, 3.0f, 1e30f, -7.25f}};
  accumulate.add(rgba_texture(GL_RGBA32F, {1, 1}, texel), timer);
  const std::vector<float> mean = accumulate.mean().download(4);
  for (int c = 0; c < 4; ++c) EXPECT_EQ(mean[size_t(c)], texel[0][c]);
}

}  // namespace
}  // namespace volgi::test
