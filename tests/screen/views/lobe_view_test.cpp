// Lobes point where light goes, and are as large as it is; radiance() is what the volume carries, on either backend.
#include "screen/views/lobe_view.h"

#include "screen/views/view_target.h"
#include "shaders/shared/grid.shared.h"
#include "tests/screen/display_target.h"
#include "tests/screen/screen_scene.h"
#include "tests/support/frame_picture.h"
#include "tests/support/gl_test.h"

namespace volgi::test {
namespace {

constexpr glm::ivec2 SIZE(128, 128);
constexpr glm::vec3 MAGENTA(0.9f, 0.1f, 0.8f);
constexpr glm::ivec3 CELL(2, 0, 1);

/// Cells 3 x 2 x 4 of half a metre, elsewhere; seen along -z from 3 m in front of CELL.
Grid lobe_grid() {
  Grid grid{};
  grid.cells = {3, 2, 4};
  grid.cell_size_m = 0.5f;
  grid.origin = {-2.0f, 1.0f, 3.0f};
  return grid;
}

class LobeView : public GlTest {
 protected:
  /// @param coefficients  of CELL; all others are dark.
  std::vector<glm::vec4> shown(const std::vector<glm::vec3>& coefficients) {
    const Grid grid = lobe_grid();
    const RadianceVolumeGl radiance(grid, int(coefficients.size()));
    for (int i = 0; i < int(coefficients.size()); ++i) {
      const glm::vec4 texel(coefficients[size_t(i)], 0.0f);
      glTextureSubImage3D(radiance.sh.id(), 0, CELL.x, CELL.y, CELL.z + i * grid.cells.z, 1, 1, 1, GL_RGBA, GL_FLOAT,
                          &texel);
    }
    const glm::vec3 middle = volgi::shared::world_from_cell(grid, glm::vec3(CELL) + 0.5f);
    const Camera camera = look_at_camera(middle + glm::vec3(0, 0, 3), middle, 0.6f, middle - 1.0f, middle + 1.0f);
    gl::PassTimer timer(context().software(), false);
    screen::ViewTarget target(SIZE);
    target.begin_overlays({}, camera, timer);
    screen::LobeView().run(radiance, camera, {.cell = CELL}, target.framebuffer(), timer);
    return texels_of(target.picture());
  }
  struct Drawn {
    glm::vec2 middle{0.0f};  // of the pixels, from the picture's middle
    float reach = 0.0f;      // of the farthest [pixels]
    int pixels = 0;
  };
  /// Pixels of the lobe that are negative, or are not; those of the cube are yellow.
  static Drawn find(const std::vector<glm::vec4>& picture, bool negative) {
    Drawn drawn;
    for (int y = 0; y < SIZE.y; ++y) {
      for (int x = 0; x < SIZE.x; ++x) {
        const glm::vec3 color(picture[size_t(y * SIZE.x + x)]);
        const bool yellow = glm::distance(color, glm::vec3(1.0f, 0.9f, 0.3f)) < 0.01f;
        if (color == glm::vec3(0.0f) || yellow) continue;
        const bool magenta = glm::distance(color / color.r * MAGENTA.r, MAGENTA) < 0.05f;
        if (magenta != negative) continue;
        const glm::vec2 at = glm::vec2(x, y) + 0.5f - 0.5f * glm::vec2(SIZE);
        drawn.middle += at;
        drawn.reach = std::max(drawn.reach, glm::length(at));
        ++drawn.pixels;
      }
    }
    drawn.middle /= float(std::max(drawn.pixels, 1));
    return drawn;
  }
};

/// Pixels of a metre at the lobe's distance.
float pixels_per_m() { return 0.5f * float(SIZE.y) / (3.0f * std::tan(0.3f)); }

TEST_F(LobeView, FirstBandPointsAlongItsAxis) {
  // Order 00, y, z, x: what is red goes along +x, what is green up, what is blue away from the viewer.
  const glm::vec3 none(0.0f);
  const std::vector<glm::vec4> right = shown({none, none, none, glm::vec3(1.0f, 0.2f, 0.2f)});
  const Drawn towards = find(right, false), back = find(right, true);
  EXPECT_GT(towards.pixels, 200);
  EXPECT_NEAR(float(back.pixels), float(towards.pixels), 0.1f * float(towards.pixels));
  EXPECT_GT(towards.middle.x, 5.0f);
  EXPECT_NEAR(towards.middle.y, 0.0f, 1.0f);
  EXPECT_NEAR(back.middle.x, -towards.middle.x, 1.0f);
  // sqrt(3) cosine of the root mean square, at 0.4 cells of half a metre.
  EXPECT_NEAR(towards.reach, std::sqrt(3.0f) * 0.2f * pixels_per_m(), 1.5f);

  const std::vector<glm::vec4> down = shown({none, glm::vec3(-1.0f), none, none});
  EXPECT_LT(find(down, false).middle.y, -5.0f);
  EXPECT_GT(find(down, true).middle.y, 5.0f);
  EXPECT_EQ(find(shown({none, none, glm::vec3(-1.0f), none}), false).pixels, 0);  // hidden by its negative half
}

TEST_F(LobeView, IsotropicLightIsASphere) {
  for (size_t coefficients : {size_t(4), size_t(9)}) {
    std::vector<glm::vec3> sh(coefficients, glm::vec3(0.0f));
    sh[0] = glm::vec3(0.3f, 0.2f, 0.1f);
    const Drawn sphere = find(shown(sh), false);
    EXPECT_NEAR(sphere.reach, 0.2f * pixels_per_m(), 1.5f);
    EXPECT_NEAR(float(sphere.pixels), glm::pi<float>() * std::pow(0.2f * pixels_per_m(), 2.0f), 150.0f);
    EXPECT_NEAR(glm::length(sphere.middle), 0.0f, 0.5f);
  }
}

TEST_F(LobeView, SecondBandHasFourLeavesOfTwoSigns) {
  std::vector<glm::vec3> sh(9, glm::vec3(0.0f));
  sh[4] = glm::vec3(1.0f);  // xy: along (1, 1) positive, along (1, -1) negative
  const std::vector<glm::vec4> picture = shown(sh);
  const float leaf = 0.1f * pixels_per_m();
  const auto at = [&](float x, float y) {
    const glm::ivec2 p(0.5f * glm::vec2(SIZE) + leaf * glm::vec2(x, y));
    return glm::vec3(picture[size_t(p.y * SIZE.x + p.x)]);
  };
  for (float sign : {-1.0f, 1.0f}) {
    EXPECT_GT(at(sign, sign).g, 0.3f);
    EXPECT_LT(at(sign, -sign).g, 0.2f);
    EXPECT_GT(at(sign, -sign).r, 0.3f);
  }
}

TEST_F(LobeView, NearestCells) {
  const Grid grid = lobe_grid();
  EXPECT_EQ(screen::nearest_cell(grid, {-2.0f + 1.1f, 1.2f, 3.0f + 0.9f}), glm::ivec3(2, 0, 1));
  EXPECT_EQ(screen::nearest_cell(grid, {-90.0f, 1e9f, 3.0f}), glm::ivec3(0, 1, 0));
}

/// The same light in the air by both twins, made once for a run.
TEST_F(LobeView, RadianceOfEitherBackend) {
  Scene scene = stage();
  scene.lights = {spot_light({0.0f, 2.5f, 1.5f}, {0.0f, -1.0f, -0.5f}, 20.0f, 40.0f, 30.0f)};
  std::vector<glm::vec4> of_backend[2];
  gl::PassTimer timer(context().software(), false);
  for (screen::Backend backend : {screen::Backend::gpu, screen::Backend::cpu}) {
    screen::FrameOptions options = picture_options("volume", glm::ivec2(32));
    options.backend = backend;
    options.of<VolumeOptions>().grid_cells = 8;
    options.of<screen::ReflectiveShadowMap::Resolution>() = {256, 32, 64};
    screen::Frame frame(scene, options);
    for (int run = 0; run < 2; ++run) {
      frame.render(stage_camera(scene), timer);
      const screen::FrameVolume* volume = frame.products().find<screen::FrameVolume>();
      ASSERT_NE(volume, nullptr);
      const RadianceVolumeGl* radiance = volume->radiance(timer);
      ASSERT_NE(radiance, nullptr);
      const std::uint64_t made = gl::objects_made();
      EXPECT_EQ(volume->radiance(timer), radiance);
      EXPECT_EQ(gl::objects_made(), made);
      of_backend[int(backend == screen::Backend::cpu)] = radiance->download()[0];
    }
  }
  ASSERT_EQ(of_backend[0].size(), of_backend[1].size());
  double sum = 0.0, apart = 0.0;
  for (size_t i = 0; i < of_backend[0].size(); ++i) {
    sum += double(of_backend[1][i].r);
    apart += std::abs(double(of_backend[0][i].r - of_backend[1][i].r));
  }
  EXPECT_GT(sum, 0.0);
  // They differ in how light comes in: by maps and by rays (tests/crosscheck has what the twins share).
  EXPECT_LT(apart / sum, 0.05);
}

}  // namespace
}  // namespace volgi::test
