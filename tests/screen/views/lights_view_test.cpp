// Disks are where lights are, as large as their flux asks for, in the colours that they should have.
#include "screen/views/lights_view.h"

#include "screen/views/view_target.h"
#include "shaders/shared/color_maps.shared.h"
#include "shaders/shared/tone_map.shared.h"
#include "tests/screen/display_target.h"
#include "tests/screen/screen_scene.h"
#include "tests/support/gl_test.h"

namespace volgi::test {
namespace {

namespace formulas = volgi::shared;
using formulas::VirtualLight;
using Mode = screen::LightsView::Mode;

constexpr glm::ivec2 SIZE(192, 160);
constexpr float STEP = 0.5f / 255.0f + 2e-4f;

class LightsView : public GlTest {
 protected:
  void SetUp() override {
    GlTest::SetUp();
    if (IsSkipped()) return;
    timer_ = std::make_unique<gl::PassTimer>(context().software(), false);
    target_ = std::make_unique<screen::ViewTarget>(SIZE);
    view_ = std::make_unique<screen::LightsView>();
    camera_ = look_at_camera({0.5f, 1.0f, 5.0f}, {0.5f, 0.5f, 0.0f}, 0.7f, glm::vec3(-3.0f), glm::vec3(3.0f));
  }
  /// Some lights far from each other, one without flux.
  static screen::VirtualLightListGl lights() {
    std::vector<VirtualLight> lights;
    for (int i = 0; i < 12; ++i) {
      VirtualLight light{};
      light.position = {-1.0f + float(i % 4), -0.6f + float(i / 4), 0.2f * float(i % 3)};
      light.normal = glm::normalize(glm::vec3(float(i % 3) - 1.0f, 1.0f, 0.5f));
      light.area_m2 = 0.01f;
      light.flux = i == 5 ? glm::vec3(0.0f) : glm::vec3(1.0f, 0.5f, 0.1f * float(i)) * (1.0f + float(i));
      light.source = i % 4 == 3 ? -1 : i % 4;
      lights.push_back(light);
    }
    screen::VirtualLightListGl list;
    list.buffer = gl::Buffer(lights);
    list.of_light = {4, 4};
    list.reflected = 8;
    list.emitted = 4;
    return list;
  }
  std::vector<glm::vec4> shown(const screen::LightsView::Shown& shown, const screen::LightsView::Options& options,
                               const screen::GBuffer* gbuffer = nullptr) {
    target_->picture().clear({0.0f, 0.0f, 0.0f, 1.0f});
    target_->begin_overlays({.gbuffer = gbuffer}, camera_, *timer_);
    view_->run(shown, camera_, options, target_->framebuffer(), *timer_);
    return texels_of(target_->picture());
  }
  /// In pixels, (0, 0) the bottom left corner.
  glm::vec2 seen_at(glm::vec3 position) const {
    const glm::vec4 clip = clip_from_camera(camera_, SIZE) * camera_from_world(camera_) * glm::vec4(position, 1.0f);
    return (0.5f + 0.5f * glm::vec2(clip) / clip.w) * glm::vec2(SIZE);
  }
  static glm::vec3 at(const std::vector<glm::vec4>& picture, glm::vec2 pixel) {
    const glm::ivec2 p(glm::floor(pixel));
    return picture[size_t(p.y * SIZE.x + p.x)];
  }
  static void expect_color(glm::vec3 shown, glm::vec3 expected, int light) {
    for (int band = 0; band < 3; ++band) EXPECT_NEAR(shown[band], expected[band], STEP) << "light " << light;
  }
  std::unique_ptr<gl::PassTimer> timer_;
  std::unique_ptr<screen::ViewTarget> target_;
  std::unique_ptr<screen::LightsView> view_;
  Camera camera_;
};

TEST_F(LightsView, AreasAreInProportionToFlux) {
  const screen::VirtualLightListGl list = lights();
  const std::vector<VirtualLight> all = download(list);
  constexpr float share = 0.15f;
  const std::vector<glm::vec4> picture =
      shown({.lights = &list}, {.share = share, .least_radius_px = 0.0f, .tick_px = 0.0f});
  float total = 0.0f;
  for (const VirtualLight& light : all) total += light.flux.r + light.flux.g + light.flux.b;
  std::vector<int> pixels(12, 0);
  int covered = 0;
  for (int y = 0; y < SIZE.y; ++y) {
    for (int x = 0; x < SIZE.x; ++x) {
      if (glm::vec3(picture[size_t(y * SIZE.x + x)]) == glm::vec3(0.0f)) continue;
      size_t nearest = 0;
      const auto distance = [&](size_t i) { return glm::distance(seen_at(all[i].position), glm::vec2(x, y) + 0.5f); };
      for (size_t i = 1; i < 12; ++i) nearest = distance(i) < distance(nearest) ? i : nearest;
      ++pixels[nearest];
      ++covered;
    }
  }
  const float picture_pixels = float(SIZE.x * SIZE.y);
  EXPECT_NEAR(float(covered), share * picture_pixels, 0.01f * share * picture_pixels);
  for (size_t i = 0; i < 12; ++i) {
    const float expected = share * picture_pixels * (all[i].flux.r + all[i].flux.g + all[i].flux.b) / total;
    // Of a disk on a lattice the number of points errs by less than half its rim.
    EXPECT_NEAR(float(pixels[i]), expected, 0.5f * std::sqrt(4.0f * glm::pi<float>() * expected)) << "light " << i;
  }
}

TEST_F(LightsView, ColorsTellHueAndSource) {
  const screen::VirtualLightListGl list = lights();
  const std::vector<VirtualLight> all = download(list);
  const std::vector<glm::vec4> by_flux = shown({.lights = &list}, {.share = 0.1f, .tick_px = 0.0f});
  const std::vector<glm::vec4> by_source =
      shown({.lights = &list}, {.mode = Mode::source, .share = 0.1f, .tick_px = 0.0f});
  for (int i = 0; i < 12; ++i) {
    const VirtualLight& light = all[size_t(i)];
    const glm::vec2 pixel = seen_at(light.position);
    if (i == 5) {
      EXPECT_EQ(at(by_flux, pixel), glm::vec3(0.0f));
      continue;
    }
    expect_color(at(by_flux, pixel), formulas::srgb_encode(light.flux / std::max(light.flux.r, light.flux.b)), i);
    expect_color(at(by_source, pixel),
                 light.source < 0 ? glm::vec3(1.0f, 0.95f, 0.7f) : formulas::hashed_color(glm::uint(light.source)), i);
  }
}

TEST_F(LightsView, ClustersAndTheirSquares) {
  const screen::VirtualLightListGl list = lights();
  const std::vector<VirtualLight> all = download(list);
  screen::VirtualAreaLights area_lights({.count = 3});
  area_lights.run(list.buffer, list.count(), 5.0f, *timer_);
  const std::vector<GLuint> cluster_of = area_lights.cluster_of().download<GLuint>(12);
  const std::vector<glm::vec4> picture =
      shown({.lights = &list, .area_lights = &area_lights},
            {.mode = Mode::cluster, .share = 0.05f, .tick_px = 0.0f, .squares = false});
  for (int i = 0; i < 12; ++i) {
    if (i == 5) continue;
    expect_color(at(picture, seen_at(all[size_t(i)].position)), formulas::hashed_color(cluster_of[size_t(i)]), i);
  }
  // Points on edges of squares are in lines.
  const std::vector<glm::vec4> squares = shown({.area_lights = &area_lights}, {});
  int tested = 0;
  const std::vector<formulas::VirtualAreaLight> areas = area_lights.download();
  for (int k = 0; k < 3; ++k) {
    const formulas::VirtualAreaLight& area = areas[size_t(k)];
    const glm::vec3 up = glm::cross(area.normal, area.right);
    for (const glm::vec3 edge : {area.right, -area.right, up, -up}) {
      const glm::vec2 pixel = seen_at(area.position + 0.5f * area.size_m * edge);
      if (glm::any(glm::lessThan(pixel, glm::vec2(2.0f))) || glm::any(glm::greaterThan(pixel, glm::vec2(SIZE) - 2.0f)))
        continue;
      bool found = false;
      for (const glm::vec2 beside :
           {glm::vec2(0), glm::vec2(1, 0), glm::vec2(-1, 0), glm::vec2(0, 1), glm::vec2(0, -1)})
        found = found || glm::distance(at(squares, pixel + beside), formulas::hashed_color(glm::uint(k))) < 0.01f;
      EXPECT_EQ(found, area.light_count > 0) << "square " << k;
      ++tested;
    }
  }
  EXPECT_GE(tested, 6);
}

TEST_F(LightsView, TicksPointAlongNormals) {
  const screen::VirtualLightListGl list = lights();
  const std::vector<VirtualLight> all = download(list);
  const std::vector<glm::vec4> picture =
      shown({.lights = &list}, {.share = 1e-6f, .least_radius_px = 1.0f, .tick_px = 14.0f});
  for (size_t i = 0; i < all.size(); ++i) {
    const glm::vec2 from = seen_at(all[i].position), along = seen_at(all[i].position + 0.1f * all[i].normal) - from;
    const glm::vec2 there = from + 7.0f * glm::normalize(along), opposite = from - 7.0f * glm::normalize(along);
    float brightest = 0.0f, behind = 0.0f;
    for (const glm::vec2 beside :
         {glm::vec2(0), glm::vec2(1, 0), glm::vec2(-1, 0), glm::vec2(0, 1), glm::vec2(0, -1)}) {
      brightest = std::max(brightest, at(picture, there + beside).r);
      behind = std::max(behind, at(picture, opposite + beside).r);
    }
    EXPECT_EQ(brightest > 0.4f, i != 5) << "light " << i;
    EXPECT_EQ(behind, 0.0f) << "light " << i;
  }
}

TEST_F(LightsView, AreHiddenByThePicture) {
  const screen::VirtualLightListGl list = lights();
  Scene scene;
  add_quad(scene, add_material(scene, glm::vec3(0.5f)), {-2.0f, -1.5f, 1.5f}, {2.5f, 0.0f, 0.0f}, {0.0f, 4.0f, 0.0f});
  update_bounds(scene);
  screen::GBuffer gbuffer(SIZE);
  gbuffer.run(gl::SceneBuffers(scene), camera_, *timer_);
  const std::vector<glm::vec4> picture = shown({.lights = &list}, {.share = 0.05f}, &gbuffer);
  const std::vector<VirtualLight> all = download(list);
  for (size_t i = 0; i < all.size(); ++i) {
    if (i == 5) continue;
    EXPECT_EQ(at(picture, seen_at(all[i].position)) == glm::vec3(0.0f), all[i].position.x < 0.3f) << "light " << i;
  }
}

}  // namespace
}  // namespace volgi::test
