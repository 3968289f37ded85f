// Errors have the sign and the colours that `compare --diff` gives them; a wipe changes at its column.
#include "screen/views/error_view.h"

#include <limits>
#include <random>

#include "core/image.h"
#include "reference/error_map.h"
#include "screen/views/wipe.h"
#include "tests/screen/display_target.h"
#include "tests/support/gl_test.h"

namespace volgi::test {
namespace {

constexpr float STEP = 0.5f / 255.0f + 2e-4f;

using ErrorView = GlTest;

TEST_F(ErrorView, IsSignedAndInItsRange) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  constexpr glm::ivec2 size(6, 1);
  const gl::Texture reference = rgba_texture(GL_RGBA32F, size, std::vector<glm::vec4>(6, glm::vec4(2.0f)));
  const gl::Texture picture = rgba_texture(GL_RGBA32F, size,
                                           {glm::vec4(2.0f),
                                            {2.5f, 2.5f, 2.5f, 0.0f},
                                            {1.0f, 2.0f, 1.5f, 0.0f},
                                            glm::vec4(9.0f),
                                            glm::vec4(nan),
                                            glm::vec4(infinity)});
  const auto shown = [&](const screen::ErrorView::Options& options) {
    const DisplayTarget target(size);
    gl::PassTimer timer(context().software(), false);
    screen::ErrorView().run(picture, reference, options, target.framebuffer, timer);
    return target.texels();
  };
  const auto expect = [](glm::vec4 texel, glm::vec3 color) {
    for (int band = 0; band < 3; ++band) EXPECT_NEAR(texel[band], color[band], STEP);
  };
  const std::vector<glm::vec4> relative = shown({});
  expect(relative[0], glm::vec3(1.0f));
  expect(relative[1], {1.0f, 0.5f, 0.5f});  // + 25 % of a range of 50 %
  expect(relative[2], {0.5f, 0.5f, 1.0f});  // - 25 %
  expect(relative[3], {1.0f, 0.0f, 0.0f});
  expect(relative[4], {1.0f, 0.0f, 1.0f});
  expect(relative[5], {0.0f, 1.0f, 1.0f});
  const std::vector<glm::vec4> absolute = shown({.relative = false, .range = 2.0f, .floor_radiance = 100.0f});
  expect(absolute[1], {1.0f, 0.75f, 0.75f});
  expect(absolute[2], {0.75f, 0.75f, 1.0f});
  expect(shown({.floor_radiance = 2.0f})[1], {1.0f, 0.75f, 0.75f});
}

TEST_F(ErrorView, IsWhatCompareShows) {
  constexpr glm::ivec2 size(20, 16);
  std::mt19937 random(5);
  std::uniform_real_distribution<float> share(0.0f, 1.0f);
  Image right(size.x, size.y), judged(size.x, size.y);
  std::vector<glm::vec4> right_texels, judged_texels;
  for (int y = 0; y < size.y; ++y) {
    for (int x = 0; x < size.x; ++x) {
      const glm::vec3 r = 3.0f * glm::vec3(share(random), share(random), share(random));
      right.at(x, size.y - 1 - y) = r;
      judged.at(x, size.y - 1 - y) = r * (0.4f + 1.2f * share(random));
      right_texels.emplace_back(right.at(x, size.y - 1 - y), 1.0f);
      judged_texels.emplace_back(judged.at(x, size.y - 1 - y), 1.0f);
    }
  }
  const gl::Texture reference = rgba_texture(GL_RGBA32F, size, right_texels);
  const DisplayTarget target(size);
  gl::PassTimer timer(context().software(), false);
  screen::ErrorView().run(rgba_texture(GL_RGBA32F, size, judged_texels), reference,
                          {.floor_radiance = screen::error_floor(reference)}, target.framebuffer, timer);
  const std::vector<glm::vec4> shown = target.texels();
  const Image expected = error_colors(right, judged, Mask(size_t(size.x * size.y), 1));
  for (int y = 0; y < size.y; ++y) {
    for (int x = 0; x < size.x; ++x) {
      for (int band = 0; band < 3; ++band)
        EXPECT_NEAR(shown[size_t(y * size.x + x)][band], expected.at(x, size.y - 1 - y)[band], STEP);
    }
  }
}

using Wipe = GlTest;

TEST_F(Wipe, ChangesAtItsColumn) {
  constexpr glm::ivec2 size(32, 3);
  const glm::vec3 left(0.3f, 0.1f, 0.6f), right(0.05f, 0.4f, 0.2f);
  gl::Texture picture = gl::Texture::make_2d(GL_RGBA32F, size.x, size.y),
              reference = gl::Texture::make_2d(GL_RGBA32F, size.x, size.y);
  picture.clear({left.r, left.g, left.b, 1.0f});
  reference.clear({right.r, right.g, right.b, 1.0f});
  gl::PassTimer timer(context().software(), false);
  screen::Wipe wipe;
  for (int column : {-1, 0, 13, 31, 32}) {
    const DisplayTarget target(size);
    wipe.run(picture, reference, 0.5f, column, target.framebuffer, timer);
    const std::vector<glm::vec4> shown = target.texels();
    for (int i = 0; i < size.x * size.y; ++i) {
      const int x = i % size.x;
      const glm::vec3 linear = tone_map((x < column ? left : right) * std::exp2(0.5f));
      for (int band = 0; band < 3; ++band)
        EXPECT_NEAR(shown[size_t(i)][band], x == column ? 1.0f : srgb_encode(linear[band]), STEP) << "column " << x;
    }
  }
}

}  // namespace
}  // namespace volgi::test
