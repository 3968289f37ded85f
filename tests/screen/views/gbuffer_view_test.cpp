// What the G-buffer holds, as colours; the G-buffer's own texels are the truth.
#include "screen/views/gbuffer_view.h"

#include <algorithm>

#include "shaders/shared/color_maps.shared.h"
#include "shaders/shared/tone_map.shared.h"
#include "tests/screen/display_target.h"
#include "tests/screen/screen_scene.h"
#include "tests/support/gl_test.h"

namespace volgi::test {
namespace {

namespace formulas = volgi::shared;
using Mode = screen::GBufferView::Mode;

constexpr glm::ivec2 SIZE(64, 48);
constexpr float STEP = 0.5f / 255.0f + 2e-4f;  // of eight bits, and of GLSL's pow()

class GBufferView : public GlTest {
 protected:
  void SetUp() override {
    GlTest::SetUp();
    if (IsSkipped()) return;
    scene_ = stage();
    scene_.materials[1].emissive_radiance = glm::vec3(0.4f, 0.2f, 0.05f);
    camera_ = stage_camera(scene_);
    timer_ = std::make_unique<gl::PassTimer>(context().software(), false);
    gbuffer_ = std::make_unique<screen::GBuffer>(SIZE);
    gbuffer_->run(gl::SceneBuffers(scene_), camera_, *timer_);
    position_ = texels_of(gbuffer_->position());
  }
  /// @param expected  of a pixel's number, where there is geometry.
  template <class Expected>
  void expect_shown(const screen::GBufferView::Options& options, const Expected& expected) {
    const DisplayTarget target(SIZE);
    screen::GBufferView().run(*gbuffer_, camera_, options, target.framebuffer, *timer_);
    const std::vector<glm::vec4> shown = target.texels();
    for (size_t i = 0; i < shown.size(); ++i) {
      const bool nothing = position_[i].w == 0.0f && options.mode != Mode::emission;
      const glm::vec3 color = nothing ? formulas::NOTHING_COLOR : expected(i);
      for (int band = 0; band < 3; ++band) ASSERT_NEAR(shown[i][band], color[band], STEP) << "pixel " << i;
    }
  }
  Scene scene_;
  Camera camera_;
  std::unique_ptr<gl::PassTimer> timer_;
  std::unique_ptr<screen::GBuffer> gbuffer_;
  std::vector<glm::vec4> position_;
};

TEST_F(GBufferView, AlbedoAndEmission) {
  const std::vector<glm::vec4> albedo = texels_of(gbuffer_->albedo()), emission = texels_of(gbuffer_->emission());
  expect_shown({}, [&](size_t i) { return formulas::srgb_encode(glm::vec3(albedo[i])); });
  expect_shown({.mode = Mode::emission, .exposure_ev = 1.0f},
               [&](size_t i) { return formulas::display_from_linear(2.0f * glm::vec3(emission[i])); });
}

TEST_F(GBufferView, Normals) {
  // Quads: both normals are the same, and those of the floor and the back wall are known.
  for (Mode mode : {Mode::shading_normal, Mode::geometric_normal}) {
    const DisplayTarget target(SIZE);
    screen::GBufferView().run(*gbuffer_, camera_, {.mode = mode}, target.framebuffer, *timer_);
    const std::vector<glm::vec4> shown = target.texels();
    int floor = 0, wall = 0;
    for (size_t i = 0; i < shown.size(); ++i) {
      if (position_[i].w == 0.0f) continue;
      const bool on_floor = std::abs(position_[i].y) < 1e-4f, on_wall = std::abs(position_[i].z + 2.0f) < 1e-4f;
      if (!on_floor && !on_wall) continue;
      const glm::vec3 normal = on_floor ? glm::vec3(0, 1, 0) : glm::vec3(0, 0, 1);
      for (int band = 0; band < 3; ++band) ASSERT_NEAR(shown[i][band], 0.5f + 0.5f * normal[band], STEP);
      (on_floor ? floor : wall) += 1;
    }
    EXPECT_GT(floor, 100);
    EXPECT_GT(wall, 100);
  }
}

TEST_F(GBufferView, DepthInMetres) {
  const screen::GBufferView::Options options{.mode = Mode::depth, .depth_range_m = {2.0f, 8.0f}};
  const glm::mat4 camera_from_scene = camera_from_world(camera_);
  const DisplayTarget target(SIZE);
  screen::GBufferView().run(*gbuffer_, camera_, options, target.framebuffer, *timer_);
  const std::vector<glm::vec4> shown = target.texels();
  int seen = 0, equal = 0;
  for (size_t i = 0; i < shown.size(); ++i) {
    if (position_[i].w == 0.0f) continue;
    const float t = (-(camera_from_scene * position_[i]).z - 2.0f) / 6.0f;
    const glm::vec3 color = formulas::viridis(t) * (0.7f + 0.3f * glm::fract(16.0f * t));
    const glm::vec3 apart = glm::abs(glm::vec3(shown[i]) - color);
    ++seen;
    equal += std::max({apart.x, apart.y, apart.z}) < STEP ? 1 : 0;
  }
  EXPECT_GT(seen, 1000);
  EXPECT_GE(equal, seen - 2);  // at a contour rounding decides
}

TEST_F(GBufferView, ObjectsHaveColorsOfTheirOwn) {
  const std::vector<float> ids = gbuffer_->object_id().download(1);
  EXPECT_GE(std::ranges::max(ids), 4.0f);
  expect_shown({.mode = Mode::object_id}, [&](size_t i) { return formulas::hashed_color(glm::uint(ids[i])); });
}

}  // namespace
}  // namespace volgi::test
