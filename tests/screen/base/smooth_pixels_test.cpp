// Which pixels smooth light is gathered at, and what the others have: known functions over a picture, no halo at a
// step, and whole frames against every pixel.
#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "core/error.h"
#include "screen/base/smooth_pixels.h"
#include "screen/frame/registry.h"
#include "tests/screen/gathered.h"
#include "tests/support/frame_picture.h"
#include "tests/support/gl_test.h"
#include "tests/support/paths.h"

namespace volgi::test {
namespace {

using Function = std::function<float(int x, int y)>;

/// Irradiance by a function of the pixel, written by the host where it is asked for.
class KnownLight : public screen::SmoothLight {
 public:
  KnownLight(glm::ivec2 size, Function f)
      : size_(size), f_(std::move(f)), radiance_(gl::Texture::make_2d(GL_RGBA32F, size.x, size.y)) {
    radiance_.clear({-1.0f, -1.0f, -1.0f, -1.0f});
  }
  void gather(const screen::WorkList& list, int /*step_px*/, std::span<const gl::Texture> irradiance,
              gl::PassTimer&) override {
    for (const GLuint packed : list.entries()) {
      const int x = int(packed & 0xffffu), y = int(packed >> 16);
      const glm::vec4 value(f_(x, y));
      glTextureSubImage2D(irradiance[0].id(), 0, x, y, 1, 1, GL_RGBA, GL_FLOAT, &value);
      ++gathered;
    }
  }
  std::vector<const gl::Texture*> radiance() const override { return {&radiance_}; }
  /// Of an albedo of 1 everywhere, which the G-buffer holds exactly.
  std::vector<glm::vec4> irradiance() const {
    std::vector<glm::vec4> of_radiance = texels(radiance_);
    for (glm::vec4& p : of_radiance) p *= glm::pi<float>();
    return of_radiance;
  }
  float truth(int x, int y) const { return f_(x, y); }

  int gathered = 0;

 private:
  glm::ivec2 size_;
  Function f_;
  gl::Texture radiance_;
};

class SmoothPixelsTest : public GlTest {
 protected:
  /// A wall that fills the picture.
  static Scene wall() {
    Scene scene;
    add_quad(scene, add_material(scene, glm::vec3(1.0f)), {-3, -3, 0}, {6, 0, 0}, {0, 6, 0});
    update_bounds(scene);
    return scene;
  }
  static Camera before(const Scene& scene) {
    return look_at_camera({0, 0, 2}, {0, 0, 0}, 1.0f, scene.bounds_min, scene.bounds_max);
  }
  struct Result {
    double worst = 0.0;  // error, in parts of 1
    double share = 0.0;  // of the pixels, gathered
  };
  static Result shown(const Scene& scene, const Camera& camera, glm::ivec2 size, const Function& f,
                      screen::SmoothPixelOptions options = {}) {
    Seen seen(context(), scene, camera, size);
    KnownLight light(size, f);
    screen::SmoothPixels pixels(size, options);
    screen::SmoothLight* const only = &light;
    pixels.run(seen.gbuffer, {&only, 1}, seen.timer);
    Result r;
    const std::vector<glm::vec4> got = light.irradiance();
    for (int y = 0; y < size.y; ++y) {
      for (int x = 0; x < size.x; ++x) {
        const size_t i = size_t(y) * size_t(size.x) + size_t(x);
        const float expected = seen.position[i].w != 0.0f ? light.truth(x, y) : 0.0f;
        r.worst = std::max(r.worst, double(std::abs(got[i].x - expected)));
      }
    }
    r.share = double(light.gathered) / double(size.x * size.y);
    EXPECT_NEAR(pixels.gathered_share(), r.share, 1e-9);
    return r;
  }
};

TEST_F(SmoothPixelsTest, ARampIsInterpolatedExactly) {
  const Scene scene = wall();
  const Result r =
      shown(scene, before(scene), {131, 97}, [](int x, int y) { return 2.0f + 0.004f * float(x) - 0.003f * float(y); });
  EXPECT_LT(r.worst, 1e-5);
  EXPECT_LT(r.share, 0.04);
}

TEST_F(SmoothPixelsTest, CurvesAreFoundWithinTheTolerance) {
  const Scene scene = wall();
  const Result r = shown(scene, before(scene), {160, 120}, [](int x, int y) {
    return 1.0f + 0.5f * std::sin(0.05f * float(x)) * std::cos(0.07f * float(y));
  });
  EXPECT_LT(r.worst, 0.03 * 1.5);
  EXPECT_LT(r.share, 0.1);
}

// Wherever the step lies on the grids, and a slanting one: no pixel has anything of the other side.
TEST_F(SmoothPixelsTest, AStepHasNoHalo) {
  const Scene scene = wall();
  for (int at = 40; at < 57; ++at) {
    const Result r = shown(scene, before(scene), {128, 64}, [at](int x, int) { return x < at ? 1.0f : 0.5f; });
    EXPECT_LT(r.worst, 0.03) << at;
    EXPECT_LT(r.share, 0.25) << at;
  }
  const Result slanting =
      shown(scene, before(scene), {128, 96}, [](int x, int y) { return 3 * x + 2 * y < 240 ? 1.0f : 0.5f; });
  EXPECT_LT(slanting.worst, 0.03);
}

// Two pictures of one surface that differ by what lies before them: the plate's pixels have nothing of the floor's.
TEST_F(SmoothPixelsTest, SurfacesDoNotMix) {
  Scene scene = wall();
  add_quad(scene, 0, {-0.4f, -0.3f, 0.5f}, {0.7f, 0, 0}, {0, 0.6f, 0});
  update_bounds(scene);
  const Camera camera = before(scene);
  const glm::ivec2 size(120, 90);
  const Seen seen(context(), scene, camera, size);
  const Result r = shown(scene, camera, size, [&](int x, int y) {
    return seen.position[size_t(y) * size_t(size.x) + size_t(x)].z > 0.25f ? 1.0f : 10.0f;
  });
  EXPECT_LT(r.worst, 1e-5);
  EXPECT_LT(r.share, 0.2);
}

// Where all is edges every pixel is gathered, once.
TEST_F(SmoothPixelsTest, NoiseIsGatheredWhole) {
  const Scene scene = wall();
  std::mt19937 random(5);
  std::vector<float> noise(96 * 64);
  for (float& n : noise) n = float(random()) / 4294967296.0f;
  const Result r = shown(scene, before(scene), {96, 64}, [&](int x, int y) { return noise[size_t(y * 96 + x)]; });
  EXPECT_GT(r.share, 0.9);
  EXPECT_LE(r.share, 1.0);
}

TEST_F(SmoothPixelsTest, OddSizesAndEveryGrid) {
  const Scene scene = wall();
  for (const int coarsest : {1, 2, 4, 8, 16, 32}) {
    for (const glm::ivec2 size : {glm::ivec2(1, 1), {3, 70}, {33, 17}}) {
      screen::SmoothPixelOptions o;
      o.coarsest = coarsest;
      const Result r = shown(
          scene, before(scene), size, [](int x, int y) { return 1.0f + 0.01f * float(x + y); }, o);
      EXPECT_LT(r.worst, 1e-5) << coarsest << ' ' << size.x;
    }
  }
}

TEST_F(SmoothPixelsTest, RefusesOtherGrids) {
  screen::SmoothPixelOptions o;
  for (const int coarsest : {0, 3, 64, -1}) {
    o.coarsest = coarsest;
    EXPECT_THROW(screen::SmoothPixels::check(o), Error) << coarsest;
  }
  o.coarsest = 16;
  o.tolerance = -1.0f;
  EXPECT_THROW(screen::SmoothPixels::check(o), Error);
}

// The row of multiresolution against every pixel with the same lights: 1.5 %. Measured at 800 x 600: 0.4, 0.2 %.
TEST_F(SmoothPixelsTest, AFrameIsThatOfEveryPixel) {
  for (const auto& [name, most] : {std::pair("cornell", 0.35), {"room", 0.35}, {"thin_wall", 0.2}}) {
    const Scene scene = load_scene(source_dir() / "data" / (std::string(name) + ".glb"));
    const auto picture = [&](const char* coarsest) {
      screen::FrameOptions o = picture_options("hybrid", {160, 160}, screen::LightPart::indirect);
      o.of<VolumeOptions>().grid_cells = 24;
      screen::set_parameter(o.settings, std::string("multires.coarsest=") + coarsest);
      return render(context(), scene, scene.cameras.at(0), o);
    };
    const Rendered every = picture("1"), some = picture("16");
    double squared = 0.0, mean = 0.0;
    for (size_t i = 0; i < every.image.pixels.size(); ++i) {
      const glm::dvec3 d(some.image.pixels[i] - every.image.pixels[i]);
      squared += glm::dot(d, d) / 3.0;
      mean += glm::dot(glm::dvec3(every.image.pixels[i]), glm::dvec3(1.0 / 3.0));
    }
    const double count = double(every.image.pixels.size());
    const double rmse = std::sqrt(squared / count) / (mean / count);
    RecordProperty(name, std::to_string(rmse));
    EXPECT_LT(rmse, 0.015) << name;
    EXPECT_LT(some.report.number("gathered_share"), most) << name;
  }
}

}  // namespace
}  // namespace volgi::test
