// Present shows what core's tone_map() and srgb_encode() say, to what eight bits can.
#include "screen/display/present.h"

#include <limits>
#include <random>

#include "core/image.h"
#include "tests/screen/display_target.h"
#include "tests/support/gl_test.h"

namespace volgi::test {
namespace {

using Present = GlTest;

/// Within half a step of eight bits, and 1e-4 for pow() of GLSL.
void expect_displayed(glm::vec4 shown, glm::vec3 radiance, float exposure_ev) {
  const glm::vec3 expected = tone_map(radiance * std::exp2(exposure_ev));
  for (int band = 0; band < 3; ++band)
    EXPECT_NEAR(shown[band], srgb_encode(expected[band]), 0.5f / 255.0f + 1e-4f) << radiance[band];
  EXPECT_EQ(shown.a, 1.0f);
}

TEST_F(Present, IsToneMapAndSrgb) {
  constexpr glm::ivec2 size(64, 48);
  std::mt19937 random(7);
  std::uniform_real_distribution<float> stops(-14.0f, 14.0f), share(0.0f, 1.0f);
  std::vector<glm::vec4> radiance;
  for (int i = 0; i < size.x * size.y; ++i) {
    const float scale = std::exp2(stops(random));
    radiance.push_back(scale * glm::vec4(share(random), share(random), share(random), 1.0f));
  }
  const gl::Texture texture = rgba_texture(GL_RGBA32F, size, radiance);
  const DisplayTarget target(size);
  gl::PassTimer timer(context().software(), false);
  screen::Present present;
  for (float exposure_ev : {0.0f, -3.5f, 2.25f}) {
    present.run(texture, exposure_ev, target.framebuffer, timer);
    const std::vector<glm::vec4> shown = target.texels();
    for (size_t i = 0; i < shown.size(); ++i) expect_displayed(shown[i], radiance[i], exposure_ev);
  }
}

TEST_F(Present, WhatIsNoNumberIsBlackAndInfinityWhite) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  const gl::Texture texture =
      rgba_texture(GL_RGBA32F, {4, 1}, {glm::vec4(nan), glm::vec4(infinity), glm::vec4(-infinity), glm::vec4(-1.0f)});
  const DisplayTarget target({4, 1});
  gl::PassTimer timer(context().software(), false);
  screen::Present().run(texture, 0.0f, target.framebuffer, timer);
  const std::vector<glm::vec4> shown = target.texels();
  EXPECT_EQ(glm::vec3(shown[0]), glm::vec3(0.0f));
  EXPECT_EQ(glm::vec3(shown[1]), glm::vec3(1.0f));
  EXPECT_EQ(glm::vec3(shown[2]), glm::vec3(0.0f));
  EXPECT_EQ(glm::vec3(shown[3]), glm::vec3(0.0f));
}

}  // namespace
}  // namespace volgi::test
