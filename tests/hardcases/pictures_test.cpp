// Whole pictures against the independent references of data/reference (192 x 192, indirect light of all bounces, region
// noedge, noise removed), and what must hold of any picture: no leak through a thin wall, times that add up.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "core/image.h"
#include "reference/metrics.h"
#include "tests/hardcases/frame_case.h"
#include "tests/support/frame_picture.h"
#include "tests/support/gl_test.h"
#include "tests/support/paths.h"

namespace volgi::test {
namespace {

namespace fs = std::filesystem;
const fs::path kData = source_dir() / "data";

Image difference(Image a, const Image& b) {
  for (size_t i = 0; i < a.pixels.size(); ++i) a.pixels[i] -= b.pixels[i];
  return a;
}

class Pictures : public GlTest {
 protected:
  static Rendered render_file(const fs::path& file, screen::FrameOptions options) {
    const Scene scene = load_scene(file);
    return render(context(), scene, scene.cameras.at(0), options);
  }

  static Metrics::Relative indirect_error(const std::string& name, Scheme scheme) {
    screen::FrameOptions options;
    options.recipe = "volume";
    options.size = {192, 192};
    options.light = screen::LightPart::indirect;
    options.of<VolumeOptions>().scheme.scheme = scheme;
    const Image test = render_file(kData / (name + ".glb"), options).image;
    const fs::path folder = kData / "reference/ref" / name;
    const Image noise = difference(read_exr_rgb(folder / "full_noise.exr"), read_exr_rgb(folder / "direct_noise.exr"));
    return error(name, difference(read_exr_rgb(folder / "full.exr"), read_exr_rgb(folder / "direct.exr")), noise, test);
  }

  /// Of `part`, "full" or "direct", by the default technique.
  static Metrics::Relative hybrid_error(const std::string& name, const std::string& part) {
    screen::FrameOptions options = picture_options("hybrid", {192, 192});
    options.of<VolumeOptions>().grid_cells = 48;
    if (part == "direct") options.light = screen::LightPart::direct;
    const Image test = render_file(kData / "reference/scenes" / (name + ".glb"), options).image;
    const fs::path folder = kData / "reference/ref" / name;
    return error(name, read_exr_rgb(folder / (part + ".exr")), read_exr_rgb(folder / (part + "_noise.exr")), test);
  }

 private:
  static Metrics::Relative error(const std::string& name, const Image& reference, const Image& noise,
                                 const Image& test) {
    const fs::path folder = kData / "reference/ref" / name;
    const ChannelImage aov = read_exr(folder / "aov.exr");
    RegionLayers layers{layer(aov, "Position"), layer(aov, "Normal"), read_exr_rgb(folder / "direct.exr"),
                        values(aov, "IndexOB.X"), values(aov, "Depth.Z")};
    const Metrics m = measure(reference, test, &noise, region_mask(Region::noedge, layers));
    EXPECT_EQ(m.nonfinite, 0);
    EXPECT_EQ(m.negative, 0);
    return m.relative.value();
  }
  static std::vector<float> values(const ChannelImage& image, const std::string& suffix) {
    for (const Channel& c : image.channels) {
      if (c.name.size() >= suffix.size() && c.name.ends_with(suffix)) return c.values;
    }
    ADD_FAILURE() << "no channel " << suffix;
    return {};
  }
  static Image layer(const ChannelImage& image, const std::string& name) {
    Image out(image.width, image.height);
    const std::vector<float> x = values(image, name + ".X"), y = values(image, name + ".Y"),
                             z = values(image, name + ".Z");
    for (size_t i = 0; i < out.pixels.size(); ++i) out.pixels[i] = {x[i], y[i], z[i]};
    return out;
  }
};

TEST_F(Pictures, CornellIndirect) {
  const auto error = indirect_error("cornell", Scheme::ordinates);
  EXPECT_NEAR(error.ratio, 1.0, 0.1);
  EXPECT_LT(error.rmse_pct_denoised.value(), 15.0);  // the issue asks for 40; 9 is reached, 15 guards it
}

// Coloured soft shadows of a textured emitter.
TEST_F(Pictures, AreaTvStraightFromTheScreen) {
  const auto error = hybrid_error("area_tv", "direct");
  EXPECT_NEAR(error.ratio, 1.0, 0.02);              // asked for: 0.05
  EXPECT_LT(error.rmse_pct_denoised.value(), 2.0);  // asked for: 10; 0.7 is reached
}

// White metal reflects the room: 17.4 % as if light were even.
TEST_F(Pictures, MetalBoxFullLight) {
  const auto error = hybrid_error("metal_box", "full");
  EXPECT_NEAR(error.ratio, 1.0, 0.03);               // asked for: 0.08
  EXPECT_LT(error.rmse_pct_denoised.value(), 11.0);  // asked for: 15; 9.1 is reached
}

TEST_F(Pictures, RoomIndirect) {
  const auto error = indirect_error("room", Scheme::ordinates);
  EXPECT_GT(error.ratio, 0.8);
  EXPECT_LT(error.ratio, 1.25);
}

TEST_F(Pictures, ThinWallDarkRoom) {
  // The right room (x > 1.1 cm) is closed to the light: under 0.5 % of the lit room's mean as placed, 2 % shifted.
  const Scene scene = load_scene(kData / "thin_wall.glb");
  const Camera& camera = scene.cameras.at(0);
  const ChannelImage aov = read_exr(kData / "reference/ref/thin_wall/aov.exr");
  const std::vector<float>* x = nullptr;
  for (const Channel& c : aov.channels) {
    if (c.name.ends_with("Position.X")) x = &c.values;
  }
  ASSERT_NE(x, nullptr);
  for (auto [cells, shift, limit] : {std::tuple(16, 0.0f, 0.005),
                                     {32, 0.0f, 0.005},
                                     {64, 0.0f, 0.005},
                                     {16, 0.25f, 0.02},
                                     {16, 0.5f, 0.02},
                                     {32, 0.25f, 0.02},
                                     {32, 0.5f, 0.02}}) {
    screen::FrameOptions options;
    options.recipe = "volume";
    options.size = {192, 192};
    options.of<VolumeOptions>().grid_cells = cells;
    options.of<VolumeOptions>().grid_shift_cells = glm::vec3(shift);
    if (cells == 64) options.of<VolumeOptions>().scheme.directions = 24;
    const Image image = render(context(), scene, camera, options).image;
    double dark = 0.0, lit = 0.0;
    int darks = 0, lits = 0;
    for (size_t i = 0; i < image.pixels.size(); ++i) {
      const float value = image.pixels[i].x + image.pixels[i].y + image.pixels[i].z;
      if ((*x)[i] > 0.011f) dark += value, ++darks;
      if ((*x)[i] < -0.011f) lit += value, ++lits;
    }
    ASSERT_GT(darks, 5000);
    EXPECT_GT(lit / lits, 0.5);
    expect_of_frame("thin", fmt::format("volume ordinates, {} cells shifted by {}", cells, shift),
                    100.0 * dark / darks * lits / lit, 100.0 * limit);
  }
}

TEST_F(Pictures, PassTimesSumToTheFrame) {
  const Scene scene = load_scene(kData / "cornell.glb");
  screen::FrameOptions options;
  options.recipe = "volume";
  options.size = {128, 128};
  options.of<VolumeOptions>().grid_cells = 16;
  options.backend = tested_backend();
  screen::Frame frame(scene, options);
  gl::PassTimer timer(context().software(), true);
  for (int f = 0; f < 3; ++f) {
    if (f == 2) timer.reset();  // one frame counts: medians of several need not add up
    timer.begin_frame();
    frame.render(scene.cameras[0], timer);
    timer.end_frame();
  }
  double sum = 0.0;
  for (const auto& pass : timer.medians()) sum += pass.gpu_ms;
  EXPECT_NEAR(sum / timer.frame_time().median_ms, 1.0, 0.1);
}

TEST_F(Pictures, AtriumRenders) {
  const fs::path file = build_dir() / "data/atrium.glb";
  ASSERT_TRUE(fs::exists(file)) << "build the target volgi_data";
  screen::FrameOptions options;
  options.recipe = "volume";
  options.size = {256, 256};
  const Image image = render_file(file, options).image;
  double sum = 0.0;
  for (const glm::vec3& p : image.pixels) {
    ASSERT_TRUE(std::isfinite(p.x + p.y + p.z));
    ASSERT_GE(std::min({p.x, p.y, p.z}), 0.0f);
    sum += p.x;
  }
  EXPECT_GT(sum / double(image.pixels.size()), 0.05);
}

TEST_F(Pictures, SameBytesTwice) {
  screen::FrameOptions options;
  options.recipe = "volume";
  options.size = {64, 64};
  options.of<VolumeOptions>().grid_cells = 16;
  const Image a = render_file(kData / "cornell.glb", options).image;
  const Image b = render_file(kData / "cornell.glb", options).image;
  EXPECT_TRUE(a.pixels == b.pixels);
}

}  // namespace
}  // namespace volgi::test
