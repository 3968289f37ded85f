// FXAA smooths steps and leaves alone what has none.
#include "screen/display/fxaa.h"

#include "tests/screen/display_target.h"
#include "tests/support/gl_test.h"

namespace volgi::test {
namespace {

constexpr glm::ivec2 SIZE(96, 64);

/// The share of a pixel below the line y = 20 + slope x, by 16 x 16 points.
float coverage(glm::ivec2 pixel, float slope) {
  int below = 0;
  for (int j = 0; j < 16; ++j) {
    for (int i = 0; i < 16; ++i) {
      const glm::vec2 p = glm::vec2(pixel) + (glm::vec2(i, j) + 0.5f) / 16.0f;
      below += p.y < 20.0f + slope * p.x ? 1 : 0;
    }
  }
  return float(below) / 256.0f;
}

class Fxaa : public GlTest {
 protected:
  std::vector<glm::vec4> filtered(const std::vector<glm::vec4>& picture, glm::ivec2 size = SIZE) {
    const gl::Texture texture = rgba_texture(GL_RGBA8, size, picture);
    const DisplayTarget target(size);
    gl::PassTimer timer(context().software(), false);
    screen::Fxaa().run(texture, target.framebuffer, timer);
    unfiltered_ = texels_of(texture);
    return target.texels();
  }
  std::vector<glm::vec4> unfiltered_;
};

TEST_F(Fxaa, SlantedEdgesComeNearTheirCoverage) {
  for (bool turned : {false, true}) {
    for (float slope : {1.0f / 4.0f, 1.0f / 8.0f, -1.0f / 12.0f, 0.4f}) {
      const glm::ivec2 size = turned ? glm::ivec2(SIZE.y, SIZE.x) : SIZE;
      std::vector<glm::vec4> stepped;
      std::vector<double> ideal;
      for (int y = 0; y < size.y; ++y) {
        for (int x = 0; x < size.x; ++x) {
          const glm::ivec2 p = turned ? glm::ivec2(y, x) : glm::ivec2(x, y);
          const bool below = float(p.y) + 0.5f < 20.0f + slope * (float(p.x) + 0.5f);
          stepped.emplace_back(glm::vec3(below ? 1.0f : 0.0f), 1.0f);
          ideal.push_back(double(coverage(p, slope)));
        }
      }
      const std::vector<glm::vec4> smooth = filtered(stepped, size);
      double before = 0.0, after = 0.0;
      for (size_t i = 0; i < ideal.size(); ++i) {
        before += std::pow(double(stepped[i].r) - ideal[i], 2.0);
        after += std::pow(double(smooth[i].r) - ideal[i], 2.0);
      }
      // Linear between the ends of a step, as coverage is; what stays is that ends lie between pixels, most where steps
      // are short (measured: 0.40 at a slope of 0.4).
      EXPECT_LT(std::sqrt(after / before), 0.45) << "slope " << slope << (turned ? ", turned" : "");
    }
  }
}

TEST_F(Fxaa, LeavesWhatHasNoEdges) {
  std::vector<glm::vec4> picture;
  for (int y = 0; y < SIZE.y; ++y) {
    for (int x = 0; x < SIZE.x; ++x)  // a slope of one level a pixel
      picture.emplace_back(float(x) / 255.0f, float(y) / 255.0f, float(x + y) / 255.0f, 1.0f);
  }
  EXPECT_EQ(filtered(picture), unfiltered_);
}

}  // namespace
}  // namespace volgi::test
