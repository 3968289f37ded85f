// The dark room of thin_wall (docs/hard-cases.md, "thin") where pictures_test.cpp and hybrid_test.cpp do not look: by
// the `conservative` scheme, and at 128 cells.
#include <gtest/gtest.h>

#include <filesystem>
#include <tuple>

#include "core/visibility/embree_scene.h"
#include "tests/hardcases/frame_case.h"
#include "tests/support/frame_picture.h"
#include "tests/support/gl_test.h"
#include "tests/support/paths.h"

namespace volgi::test {
namespace {

class Leak : public GlTest {
 protected:
  static constexpr glm::ivec2 kSize{96, 96};

  static screen::FrameOptions options(int cells, float shift) {
    screen::FrameOptions o;
    o.recipe = "volume";
    o.size = kSize;
    o.of<VolumeOptions>().grid_cells = cells;
    o.of<VolumeOptions>().grid_shift_cells = glm::vec3(shift);
    return o;
  }

  /// Light in the dark room over light in the lit one, each the mean of its pixels.
  double leak(const screen::FrameOptions& o) const {
    const Image image = render(context(), scene_, camera_, o).image;
    double dark = 0.0, lit = 0.0;
    int darks = 0, lits = 0;
    for (int y = 0; y < kSize.y; ++y) {
      for (int x = 0; x < kSize.x; ++x) {
        const CameraRay ray = camera_ray(camera_, glm::vec2(x, y) + 0.5f, kSize);
        RayHit hit;
        if (!rays_.intersect(ray.origin, ray.direction, 1e6f, 0, hit)) continue;
        const double world_x = double(ray.origin.x + hit.distance * ray.direction.x) + scene_.world_origin.x;
        const double value = double(image.at(x, y).x + image.at(x, y).y + image.at(x, y).z);
        if (world_x > 0.011) dark += value, ++darks;
        if (world_x < -0.011) lit += value, ++lits;
      }
    }
    EXPECT_GT(darks, 1000);
    EXPECT_GT(lits, 1000);
    return dark / darks * lits / lit;
  }

  void expect_below(double limit, const screen::FrameOptions& o, const std::string& what) const {
    expect_of_frame("thin", what, 100.0 * leak(o), 100.0 * limit);
  }

  static std::string name(const char* mode, int cells, float shift) {
    return fmt::format("{}, {} cells shifted by {}", mode, cells, shift);
  }

 private:
  const Scene scene_ = load_scene(source_dir() / "data/thin_wall.glb");
  const Camera& camera_ = scene_.cameras.at(0);
  const EmbreeScene rays_{scene_};
};

TEST_F(Leak, ThinWallConservative) {
  for (auto [cells, shift, limit] :
       {std::tuple(16, 0.0f, 0.005), {24, 0.0f, 0.005}, {16, 0.25f, 0.02}, {16, 0.5f, 0.02}}) {
    screen::FrameOptions o = options(cells, shift);
    o.of<VolumeOptions>().scheme.scheme = Scheme::conservative;
    expect_below(limit, o, name("volume conservative", cells, shift));
  }
}

// On the GPU's volume it is the test thin_wall_128 (CMakeLists.txt).
TEST_F(Leak, ThinWallAt128Cells) {
  for (auto [shift, limit] : {std::pair(0.0f, 0.005), {0.25f, 0.02}, {0.5f, 0.02}}) {
    for (auto [gi, mode] : {std::pair(Gi("volume"), "volume"), {Gi("hybrid"), "hybrid"}}) {
      screen::FrameOptions o = options(128, shift);
      o.recipe = gi;
      expect_below(limit, o, name(mode, 128, shift));
    }
  }
}

// `val` has no grid, and no other test of its own.
TEST_F(Leak, ThinWallByAreaLightsOnGpuOnly) {
  if (const char* reason = reason_to_skip(TestedOn::gpu_only, context())) GTEST_SKIP() << reason;
  screen::FrameOptions o = options(16, 0.0f);
  o.recipe = "val";
  expect_below(0.005, o, "val");
}

TEST_F(Leak, ThinWallHybrid) {
  for (auto [cells, shift, limit] : {std::tuple(16, 0.0f, 0.005),
                                     {64, 0.0f, 0.005},
                                     {16, 0.25f, 0.02},
                                     {16, 0.5f, 0.02},
                                     {32, 0.25f, 0.02},
                                     {32, 0.5f, 0.02}}) {
    screen::FrameOptions o = options(cells, shift);
    o.recipe = "hybrid";
    if (cells == 64) o.of<VolumeOptions>().scheme.directions = 24;
    expect_below(limit, o, name("hybrid", cells, shift));
  }
}

}  // namespace
}  // namespace volgi::test
