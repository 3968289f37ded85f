// Pictures that are averaged: each is made of other pixels and other virtual lights, and their mean comes to be what a
// picture of as many lights as all of them together is.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/gl/objects.h"
#include "core/sky.h"
#include "reference/metrics.h"
#include "reference/path_tracer.h"
#include "screen/gather/gather_choice.h"
#include "screen/sources/sky/sky_maps.h"
#include "tests/screen/screen_scene.h"
#include "tests/support/frame_picture.h"
#include "tests/support/gl_test.h"
#include "tests/support/paths.h"

namespace volgi::test {
namespace {

bool same_bytes(const Image& a, const Image& b) {
  return std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof(glm::vec3)) == 0;
}

class Progressive : public GlTest {
 protected:
  static screen::FrameOptions options(Gi gi, int size = 48) {
    screen::FrameOptions o = picture_options(gi, glm::ivec2(size), screen::LightPart::indirect);
    o.backend = screen::Backend::cpu;
    o.of<VolumeOptions>().grid_cells = 16;
    o.of<screen::VirtualLightOptions>().count = 128;
    o.of<screen::VirtualAreaLightOptions>().count = 32;
    o.of<screen::AreaMapOptions>().texels = 128;
    if (gi != Gi("hybrid")) o.of<screen::SkyOptions>().first = screen::SkyOptions::First::lights;
    return o;
  }
  /// A lamp, a sun, something that glows, the sky.
  static Scene lit_stage() {
    Scene scene = stage();
    scene.materials.push_back(scene.materials[0]);
    scene.materials.back().emissive_radiance = glm::vec3(2.0f);
    add_quad(scene, int(scene.materials.size()) - 1, {1.0f, 1.5f, -1.0f}, {0.0f, 0.0f, 0.4f}, {0.4f, 0.0f, 0.0f});
    scene.lights = {spot_light({0.0f, 2.5f, 1.5f}, {0.0f, -1.0f, -0.5f}, 20.0f, 40.0f, 30.0f),
                    sun_light({0.2f, -1.0f, -0.3f}, 1.0f)};
    scene.sky = std::make_shared<Sky>(glm::vec3(0.5f));
    update_bounds(scene);
    return scene;
  }
};

/// A frame, and what it makes of samples.
class Pictures {
 public:
  Pictures(const gl::Context& context, const Scene& scene, const Camera& camera, const screen::FrameOptions& options)
      : camera_(camera), frame_(scene, options), timer_(context.software(), false) {}
  Image untold() {
    frame_.render(camera_, timer_);
    return screen::image_from_texture(frame_.radiance());
  }
  Image sample(int index, bool jitter = true) {
    frame_.set_sample(index, jitter);
    return untold();
  }
  /// Of samples 0 ... n - 1, n = `counts` in rising order.
  std::vector<Image> means(const std::vector<int>& counts) {
    std::vector<Image> means;
    Image sum;
    for (int k = 0; k < counts.back(); ++k) {
      const Image next = sample(k);
      if (k == 0) {
        sum = next;
      } else {
        for (size_t i = 0; i < sum.pixels.size(); ++i) sum.pixels[i] += next.pixels[i];
      }
      if (std::find(counts.begin(), counts.end(), k + 1) == counts.end()) continue;
      means.push_back(sum);
      for (glm::vec3& p : means.back().pixels) p /= float(k + 1);
    }
    return means;
  }

 private:
  Camera camera_;
  screen::Frame frame_;
  gl::PassTimer timer_;
};

TEST_F(Progressive, SampleZeroIsAFrameThatNobodyHasTold) {
  const Scene scene = lit_stage();
  for (const Gi gi : {Gi("hybrid"), Gi("negative")}) {
    const Image untold = Pictures(context(), scene, stage_camera(scene), options(gi)).untold();
    Pictures pictures(context(), scene, stage_camera(scene), options(gi));
    EXPECT_TRUE(same_bytes(pictures.sample(0), untold)) << gi;
    EXPECT_TRUE(same_bytes(pictures.sample(5, false), untold)) << gi << ": nothing is half transparent";
    EXPECT_FALSE(same_bytes(pictures.sample(5), untold)) << gi;
    EXPECT_TRUE(same_bytes(pictures.sample(0), untold)) << gi;
  }
}

TEST_F(Progressive, ASampleDependsOnItsIndexAlone) {
  const Scene scene = lit_stage();
  for (const Gi gi : {Gi("hybrid"), Gi("negative"), Gi("val"), Gi("vpl")}) {
    screen::FrameOptions o = options(gi);
    if (gi == Gi("val")) o.of<screen::VirtualLightOptions>().sampling = screen::VirtualLightOptions::Sampling::flux;
    Pictures pictures(context(), scene, stage_camera(scene), o);
    const Image three = pictures.sample(3), four = pictures.sample(4);
    EXPECT_FALSE(same_bytes(three, four)) << gi;
    Pictures others(context(), scene, stage_camera(scene), o);
    EXPECT_TRUE(same_bytes(others.sample(4), four)) << gi;
    EXPECT_TRUE(same_bytes(others.sample(3), three)) << gi;
  }
}

TEST_F(Progressive, OtherSamplesMakeNoObjects) {
  const Scene scene = lit_stage();
  for (const Gi gi : {Gi("hybrid"), Gi("negative"), Gi("val")}) {
    Pictures pictures(context(), scene, stage_camera(scene), options(gi));
    for (int k = 0; k < 2; ++k) pictures.sample(k);
    const std::uint64_t before = gl::objects_made();
    for (int k = 2; k < 5; ++k) pictures.sample(k);
    EXPECT_EQ(gl::objects_made(), before) << gi;
  }
}

/// Root mean square difference where `mask` is, in percent of the mean of `truth`; and ratio of the means.
struct Difference {
  double rmse_percent, ratio;
};
Difference difference(const Image& truth, const Image& image, const Mask& mask) {
  const Metrics m = measure(truth, image, nullptr, mask);
  return {m.relative.value().rmse_pct, m.relative.value().ratio};
}

// Edges aside, which the mean shows smooth and a picture of pixel centres does not. One bounce: what the volume errs is
// the same in all.
TEST_F(Progressive, MeansComeToBeAPictureOfManyMoreLights) {
  const Scene scene = load_scene(source_dir() / "data/cornell.glb");
  const Camera camera = scene.cameras.at(0);
  PathTracerOptions paths;
  paths.size = glm::ivec2(64);
  paths.samples_per_pixel = 256;
  paths.light = PathTracerOptions::Light::indirect;
  paths.max_bounces = 1;
  const ReferencePicture reference = path_trace(scene, camera, paths);
  const Mask mask = region_mask(
      Region::noedge, {reference.position, reference.normal, reference.direct, reference.id, reference.depth});
  screen::FrameOptions o = options("val", 64);
  screen::prefer_interleaved_gather(o.settings);
  o.of<screen::VirtualLightOptions>().count = 512;
  o.of<screen::VirtualAreaLightOptions>().count = 64;
  o.of<screen::AreaLightGatherOptions>().interleave = 1;
  const std::vector<int> counts{1, 4, 16, 64};
  Pictures pictures(context(), scene, camera, o);
  const std::vector<Image> means = pictures.means(counts);
  o.of<screen::VirtualLightOptions>().count *= 64;
  o.of<screen::VirtualAreaLightOptions>().count = 256;
  const Image many = Pictures(context(), scene, camera, o).untold();
  // Samples after the first err more by themselves, as clusters are seen from any of their lights.
  double alone = 0.0;
  for (const int k : {1, 2, 3, 4})
    alone += 0.25 * std::pow(difference(many, pictures.sample(k), mask).rmse_percent, 2.0);
  // What is left of the light of 64 clusters in maps of 128 x 128 and of what is near lights. Measured: 4.6 (those
  // after the first, alone, 7.4), 3.8, 2.1 and 1.84 % of 1, 4, 16 and 64, energy of 64 0.9958 of the many's, 0.9972 of
  // the paths'.
  constexpr double bias = 2.0;
  const double noise = difference(reference.color, many, mask).rmse_percent;  // the paths' own, 9.5 %
  for (size_t i = 0; i < counts.size(); ++i) {
    const Difference to_many = difference(many, means[i], mask), to_paths = difference(reference.color, means[i], mask);
    RecordProperty(fmt::format("means_of_{}", counts[i]),
                   fmt::format("{:.2f} % {:.4f}, to paths {:.2f} % {:.4f}", to_many.rmse_percent, to_many.ratio,
                               to_paths.rmse_percent, to_paths.ratio));
    if (counts[i] == 1) continue;
    EXPECT_LT(to_many.rmse_percent, std::sqrt(bias * bias + alone / counts[i])) << counts[i];
    EXPECT_LT(to_paths.rmse_percent, std::sqrt(noise * noise + bias * bias + alone / counts[i])) << counts[i];
  }
  EXPECT_LT(difference(many, means.back(), mask).rmse_percent, bias);
  EXPECT_NEAR(difference(many, means.back(), mask).ratio, 1.0, 0.007);
  EXPECT_NEAR(difference(reference.color, means.back(), mask).ratio, 1.0, 0.005);
}

}  // namespace
}  // namespace volgi::test
