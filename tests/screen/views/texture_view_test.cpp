// Textures of every kind, as colours that can be told beforehand.
#include "screen/views/texture_view.h"

#include <limits>

#include "shaders/shared/color_maps.shared.h"
#include "shaders/shared/tone_map.shared.h"
#include "tests/screen/display_target.h"
#include "tests/support/gl_test.h"

namespace volgi::test {
namespace {

namespace formulas = volgi::shared;
using Channel = screen::TextureView::Channel;
using Fit = screen::TextureView::Fit;
using Options = screen::TextureView::Options;

constexpr float NAN_F = std::numeric_limits<float>::quiet_NaN(), INFINITE_F = std::numeric_limits<float>::infinity();
constexpr float STEP = 0.5f / 255.0f + 1e-4f;  // of eight bits, and of GLSL's pow() and log()

void expect_color(glm::vec4 shown, glm::vec3 expected, const char* what) {
  for (int band = 0; band < 3; ++band) EXPECT_NEAR(shown[band], expected[band], STEP) << what << ", band " << band;
  EXPECT_EQ(shown.a, 1.0f);
}

class TextureView : public GlTest {
 protected:
  std::vector<glm::vec4> shown(const gl::Texture& texture, const Options& options, glm::ivec2 size) {
    const DisplayTarget target(size);
    gl::PassTimer timer(context().software(), false);
    view_.run(texture, options, target.framebuffer, timer);
    return target.texels();
  }
  /// The first texel alone.
  glm::vec4 pixel(const gl::Texture& texture, Options options) {
    options.fit = Fit::stretch;
    return shown(texture, options, glm::ivec2(texture.size())).front();
  }
  screen::TextureView view_;  // makes its programs when they are needed
};

TEST_F(TextureView, ChannelsAndRanges) {
  const gl::Texture texture = rgba_texture(GL_RGBA32F, {1, 1}, {{0.5f, -2.0f, 30.0f, 0.25f}});
  expect_color(pixel(texture, {}), {formulas::srgb_encode(0.5f), 0.0f, 1.0f}, "light");
  expect_color(pixel(texture, {.range = {-2.0f, 30.0f}, .encode = false}), {2.5f / 32.0f, 0.0f, 1.0f}, "numbers");
  expect_color(pixel(texture, {.channel = Channel::red}), formulas::viridis(0.5f), "red");
  expect_color(pixel(texture, {.range = {-4.0f, 0.0f}, .channel = Channel::green}), formulas::viridis(0.5f), "green");
  expect_color(pixel(texture, {.range = {0.0f, 40.0f}, .channel = Channel::blue}), formulas::viridis(0.75f), "blue");
  expect_color(pixel(texture, {.channel = Channel::alpha}), formulas::viridis(0.25f), "alpha");
  const float length = std::sqrt(0.25f + 4.0f + 900.0f);
  expect_color(pixel(texture, {.range = {0.0f, 100.0f}, .channel = Channel::length}),
               formulas::viridis(length / 100.0f), "length");
  expect_color(pixel(texture, {.range = {3.0f, 300.0f}, .log_scale = true, .channel = Channel::blue}),
               formulas::viridis(0.5f), "log scale");
  expect_color(pixel(texture, {.range = {-1.0f, 100.0f}, .log_scale = true, .channel = Channel::green}),
               formulas::viridis(0.0f), "below zero on a log scale");
  expect_color(pixel(texture, {.range = {0.5f, 0.5f}, .channel = Channel::blue}), formulas::viridis(1.0f), "no range");
}

TEST_F(TextureView, MarksWhatIsNotFinite) {
  const gl::Texture texture = rgba_texture(
      GL_RGBA32F, {4, 1},
      {{0.5f, NAN_F, 0.5f, 1.0f}, {INFINITE_F, 0.0f, 0.0f, 1.0f}, {0.0f, -INFINITE_F, 0.0f, 1.0f}, glm::vec4(0.0f)});
  const std::vector<glm::vec4> rgb = shown(texture, {.fit = Fit::stretch}, {4, 1});
  expect_color(rgb[0], formulas::NAN_COLOR, "NaN");
  expect_color(rgb[1], formulas::INFINITY_COLOR, "infinity");
  expect_color(rgb[2], formulas::INFINITY_COLOR, "minus infinity");
  expect_color(rgb[3], glm::vec3(0.0f), "zero");
  const std::vector<glm::vec4> red = shown(texture, {.channel = Channel::red, .fit = Fit::stretch}, {4, 1});
  expect_color(red[0], formulas::viridis(0.5f), "of another channel");
  expect_color(red[1], formulas::INFINITY_COLOR, "infinity");
}

TEST_F(TextureView, EveryKindOfTexture) {
  constexpr GLuint ids[] = {7, 3000000001u, 9, 10};
  gl::Texture integers = gl::Texture::make_2d(GL_R32UI, 2, 2);
  glTextureSubImage2D(integers.id(), 0, 0, 0, 2, 2, GL_RED_INTEGER, GL_UNSIGNED_INT, ids);
  expect_color(pixel(integers, {.range = {0.0f, 14.0f}, .channel = Channel::red}), formulas::viridis(0.5f), "uint");
  EXPECT_EQ(screen::texel(integers, 0, {1, 0}).value, glm::dvec4(3000000001.0, 0.0, 0.0, 1.0));

  const GLint negative[] = {-5, 0, 0, 0};
  gl::Texture signed_integers = gl::Texture::make_2d(GL_R32I, 2, 2);
  glTextureSubImage2D(signed_integers.id(), 0, 0, 0, 2, 2, GL_RED_INTEGER, GL_INT, negative);
  expect_color(pixel(signed_integers, {.range = {-10.0f, 0.0f}, .channel = Channel::red}), formulas::viridis(0.5f),
               "int");
  EXPECT_EQ(screen::texel(signed_integers, 0, {0, 0}).value.x, -5.0);

  constexpr float depths[] = {0.75f, 0.0f, 0.0f, 1.0f};
  gl::Texture depth = gl::Texture::make_2d(GL_DEPTH_COMPONENT32F, 2, 2);
  glTextureSubImage2D(depth.id(), 0, 0, 0, 2, 2, GL_DEPTH_COMPONENT, GL_FLOAT, depths);
  expect_color(pixel(depth, {.channel = Channel::red}), formulas::viridis(0.75f), "depth");
  EXPECT_TRUE(screen::texel_kind(depth).depth);
  EXPECT_EQ(screen::texel(depth, 0, {1, 1}).value.x, 1.0);

  const gl::Texture snorm = rgba_texture(GL_RGBA16_SNORM, {1, 1}, {{-1.0f, 0.0f, 1.0f, 0.5f}});
  expect_color(pixel(snorm, {.range = {-1.0f, 1.0f}, .encode = false}), {0.0f, 0.5f, 1.0f}, "snorm");
  EXPECT_NEAR(screen::texel(snorm, 0, {0, 0}).value.w, 0.5, 1e-4);
}

TEST_F(TextureView, LayersAndSlices) {
  const gl::Texture array = gl::Texture::make_2d_array(GL_R32F, 2, 1, 3),
                    volume = gl::Texture::make_3d(GL_R32F, {2, 1, 3});
  constexpr float values[] = {0.0f, 0.1f, 0.2f, 0.3f, 0.4f, 0.5f};
  for (const gl::Texture* texture : {&array, &volume}) {
    glTextureSubImage3D(texture->id(), 0, 0, 0, 0, 2, 1, 3, GL_RED, GL_FLOAT, values);
    expect_color(pixel(*texture, {.layer = 1, .channel = Channel::red}), formulas::viridis(0.2f), "layer 1");
    expect_color(pixel(*texture, {.layer = 9, .channel = Channel::red}), formulas::viridis(0.4f), "the last layer");
    EXPECT_EQ(screen::texel(*texture, 2, {1, 0}).value.x, double(0.5f));
    EXPECT_EQ(screen::texel_kind(*texture).channels, 1);
  }
  EXPECT_EQ(screen::texel_kind(volume).target, GLenum(GL_TEXTURE_3D));
}

TEST_F(TextureView, FitsAndSaysWhichTexelIsWhere) {
  constexpr glm::ivec2 size(4, 2), target(32, 24);
  std::vector<glm::vec4> texels;
  for (int i = 0; i < size.x * size.y; ++i) texels.emplace_back(float(i + 1) / 16.0f);
  const gl::Texture texture = rgba_texture(GL_RGBA32F, size, texels);
  for (Fit fit : {Fit::aspect, Fit::stretch, Fit::texels}) {
    const std::vector<glm::vec4> picture = shown(texture, {.channel = Channel::red, .fit = fit}, target);
    int covered = 0;
    for (int y = 0; y < target.y; ++y) {
      for (int x = 0; x < target.x; ++x) {
        const auto texel = screen::TextureView::texel_at(size, fit, target, glm::vec2(x, y) + 0.5f);
        const glm::vec3 expected =
            texel ? formulas::viridis(float(texel->x + 4 * texel->y + 1) / 16.0f) : formulas::NOTHING_COLOR;
        expect_color(picture[size_t(y * target.x + x)], expected, "pixel");
        covered += texel ? 1 : 0;
      }
    }
    EXPECT_EQ(covered, fit == Fit::texels ? 8 : fit == Fit::aspect ? 32 * 16 : 32 * 24);
  }
  EXPECT_EQ(screen::TextureView::texel_at(size, Fit::aspect, target, {31.5f, 4.5f}), glm::ivec2(3, 0));
}

TEST_F(TextureView, AutomaticRangeLeavesOutliersOut) {
  std::vector<glm::vec4> texels;
  for (int i = 0; i < 1000; ++i) texels.emplace_back(float(i), -1.0f, 2.0f, 0.0f);
  texels[0].x = -INFINITE_F;
  texels[1].x = NAN_F;
  texels[2].x = 1e9f;
  const gl::Texture texture = rgba_texture(GL_RGBA32F, {100, 10}, texels);
  const glm::vec2 red = screen::automatic_range(texture, 0, Channel::red);
  EXPECT_NEAR(red.x, 12.0f, 2.0f);
  EXPECT_NEAR(red.y, 990.0f, 2.0f);
  const glm::vec2 constant = screen::automatic_range(texture, 0, Channel::blue);
  EXPECT_EQ(constant, glm::vec2(2.0f, 4.0f));
  EXPECT_EQ(screen::automatic_range(texture, 0, Channel::green, true), glm::vec2(0.0f, 1.0f));  // nothing above zero
}

}  // namespace
}  // namespace volgi::test
