// The figures of data/reference/compare.py, which is normative, and those that it does not have.
#include "reference/metrics.h"

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <map>
#include <sstream>

#include "core/error.h"
#include "reference/error_map.h"
#include "reference/fit_hint.h"
#include "reference/picture_files.h"
#include "tests/support/paths.h"

namespace volgi {
namespace {

const std::string kData = (test::source_dir() / "data/reference/ref").string() + "/";

struct Pictures {
  ReferenceFile reference;
  Image test;
};

const Pictures& pictures(const std::string& scene, const std::string& light) {
  static std::map<std::string, Pictures> cache;
  const auto found = cache.find(scene + light);
  if (found != cache.end()) return found->second;
  const bool indirect = light == "indirect";
  Pictures p;
  p.reference = read_reference(kData + scene + "/full.exr",
                               indirect ? PathTracerOptions::Light::indirect : PathTracerOptions::Light::full);
  p.test = read_exr_rgb(kData + scene + "/one.exr");
  const Image direct = read_exr_rgb(kData + scene + "/direct.exr");
  for (size_t i = 0; indirect && i < p.test.pixels.size(); ++i) p.test.pixels[i] -= direct.pixels[i];
  return cache.emplace(scene + light, std::move(p)).first->second;
}

std::map<std::string, double> figures(const Metrics& m) {
  std::map<std::string, double> out{{"pixels", m.pixels},
                                    {"nonfinite", m.nonfinite},
                                    {"negative", m.negative},
                                    {"ref_mean", m.ref_mean},
                                    {"test_mean", m.test_mean}};
  if (!m.relative) return out["test_max"] = m.test_max, out;
  const Metrics::Relative& r = *m.relative;
  out.insert({{"ratio", r.ratio},
              {"rmse_pct", r.rmse_pct},
              {"relmse", r.relmse},
              {"scale", r.scale},
              {"ssim", r.ssim},
              {"p95_percent", r.p95_percent}});
  const auto put = [&](const char* key, const std::optional<double>& value) {
    if (value) out[key] = *value;
  };
  put("rmse_pct_denoised", r.rmse_pct_denoised);
  put("relmse_denoised", r.relmse_denoised);
  put("blk_pct", r.blk_pct);
  put("blkmax_pct", r.blkmax_pct);
  put("blkbias_pct", r.blkbias_pct);
  return out;
}

// Checks every line "scene light region key value"; relative 1e-4, and 1e-9 where a figure is a difference of sums. A
// region is the same to the pixel.
void expect_figures(std::istream& lines) {
  std::string scene, light, region, key, value, last;
  std::map<std::string, double> own;
  int checked = 0;
  while (lines >> scene >> light >> region >> key >> value) {
    const std::string which = (std::ostringstream() << scene << ' ' << light << ' ' << region).str();
    if (which != last) {
      const Pictures& p = pictures(scene, light);
      const Mask mask = region_mask(*region_from_name(region), *p.reference.layers);
      own = figures(measure(p.reference.color, p.test, &*p.reference.noise, mask));
      last = which;
    }
    ASSERT_TRUE(own.contains(key)) << which << " " << key;
    const double expected = std::strtod(value.c_str(), nullptr);
    if (key == "pixels") {
      EXPECT_EQ(own[key], expected) << which;
    } else if (std::isnan(expected)) {
      EXPECT_TRUE(std::isnan(own[key])) << which << " " << key;
    } else {
      EXPECT_NEAR(own[key], expected, 1e-4 * std::abs(expected) + 1e-9) << which << " " << key;
    }
    ++checked;
  }
  EXPECT_GT(checked, 300);
}

TEST(Compare, AgreesWithStoredFiguresOfComparePy) {
  std::ifstream file(test::source_dir() / "tests/reference/compare_figures.txt");
  ASSERT_TRUE(file);
  expect_figures(file);
}

TEST(Compare, AgreesWithComparePyRunNow) {
  std::FILE* python = popen(
      ("/usr/bin/python3 '" + (test::source_dir() / "tests/reference/compare_figures.py").string() + "' 2>/dev/null")
          .c_str(),
      "r");
  ASSERT_NE(python, nullptr);
  std::string output(1 << 16, '\0');
  size_t size = 0;
  while (const size_t got = std::fread(output.data() + size, 1, output.size() - size, python)) {
    size += got;
    if (size == output.size()) output.resize(2 * size);
  }
  output.resize(size);
  const int status = pclose(python);
  if (WIFEXITED(status) && (WEXITSTATUS(status) == 77 || WEXITSTATUS(status) == 127))
    GTEST_SKIP() << "needs python3-numpy and python3-openimageio; the stored figures are checked";
  ASSERT_EQ(status, 0);
  std::istringstream lines(output);
  expect_figures(lines);
}

Image ramp(int width, int height) {
  Image image(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) image.at(x, y) = glm::vec3(1.0f + 0.01f * static_cast<float>(x + y));
  return image;
}

TEST(Compare, ConstantFactor) {
  const Image ref = ramp(64, 48);
  Image test = ref;
  for (glm::vec3& t : test.pixels) t *= 1.1f;
  const Metrics m = measure(ref, test, nullptr, Mask(ref.pixels.size(), 1));
  EXPECT_NEAR(m.relative->ratio, 1.1, 1e-6);
  EXPECT_NEAR(m.relative->scale, 1 / 1.1, 1e-6);
  EXPECT_NEAR(m.relative->p95_percent, 10, 1e-4);
  EXPECT_FALSE(m.relative->rmse_pct_denoised);
}

TEST(Compare, IdenticalPicturesDifferByNothing) {
  const Image ref = ramp(64, 48);
  const Metrics m = measure(ref, ref, nullptr, Mask(ref.pixels.size(), 1));
  EXPECT_EQ(m.max_absolute, 0.0);
  EXPECT_EQ(m.relative->rmse_pct, 0.0);
  EXPECT_EQ(*m.relative->blk_pct, 0.0);
  EXPECT_NEAR(m.relative->ssim, 1.0, 1e-12);
}

TEST(Compare, NotANumberIsCountedNotAveragedAway) {
  const Image ref = ramp(32, 32);
  Image test = ref;
  test.at(3, 4).y = std::numeric_limits<float>::quiet_NaN();
  test.at(5, 5).x = -std::numeric_limits<float>::infinity();
  const Metrics m = measure(ref, test, nullptr, Mask(ref.pixels.size(), 1));
  EXPECT_EQ(m.nonfinite, 2);
  EXPECT_EQ(m.negative, 1);
  EXPECT_GT(m.relative->rmse_pct, 1.0) << "they count as black";
}

TEST(Compare, BlackReferenceHasAbsoluteFiguresOnly) {
  const Image black(16, 16);
  Image test = black;
  test.at(7, 7) = glm::vec3(0.5f, 0, 0);
  const Metrics m = measure(black, test, nullptr, Mask(256, 1));
  EXPECT_FALSE(m.relative);
  EXPECT_EQ(m.max_absolute, 0.5);
  EXPECT_NEAR(m.mean_absolute, 0.5 / 768, 1e-9);
}

TEST(Compare, EmptyRegion) {
  const Image ref = ramp(8, 8);
  const Metrics m = measure(ref, ref, nullptr, Mask(64, 0));
  EXPECT_EQ(m.pixels, 0);
  EXPECT_FALSE(m.relative);
}

// A wall that a lamp lights evenly, but for the columns from `shadow_from` on, where other light is as bright.
RegionLayers wall(int size, int shadow_from) {
  RegionLayers l;
  const auto pixels = static_cast<size_t>(size * size);
  l.position = l.direct_noise = Image(size, size);
  l.normal = Image(size, size, {0, 0, 1});
  l.direct = Image(size, size, glm::vec3(1.0f));
  l.id.assign(pixels, 1.0f);
  l.depth.assign(pixels, 1.0f);
  for (size_t i = 0; i < pixels; ++i) l.lit.push_back(static_cast<int>(i) % size < shadow_from ? 1.0f : 0.0f);
  return l;
}

int pixels(Region region, const RegionLayers& layers) {
  const Mask mask = region_mask(region, layers);
  return static_cast<int>(std::count(mask.begin(), mask.end(), 1));
}

TEST(Regions, BordersOfWhatLightsReachAreEdges) {
  RegionLayers l = wall(16, 6);
  EXPECT_EQ(pixels(Region::noedge, l), 16 * 14);
  EXPECT_EQ(pixels(Region::shade, l), 16 * 9);
  EXPECT_EQ(pixels(Region::shadow, l), 0) << "other light is there";
  l.lit.clear();
  EXPECT_EQ(pixels(Region::noedge, l), 16 * 16);
  EXPECT_EQ(pixels(Region::shade, l), 0) << "all direct light is taken to be that of lamps";
}

TEST(Regions, NoiseOfDirectLightIsNoEdge) {
  RegionLayers l = wall(16, 16);
  l.direct.at(8, 8) = glm::vec3(0.5f);
  EXPECT_EQ(pixels(Region::noedge, l), 16 * 16 - 9);
  // The rule: 5 times the RMS of the noise must reach 1.5 - 0.35 * 3 = 0.45 in the sum of R, G, B.
  l.direct_noise = Image(16, 16, glm::vec3(0.02f));
  EXPECT_EQ(pixels(Region::noedge, l), 16 * 16 - 9);
  l.direct_noise = Image(16, 16, glm::vec3(0.04f));
  EXPECT_EQ(pixels(Region::noedge, l), 16 * 16);
  l.lit.clear();
  EXPECT_EQ(pixels(Region::noedge, l), 16 * 16 - 9) << "without `lit` light has no noise";
}

TEST(FitHint, NamesWhatWouldHelp) {
  const Image ref = ramp(32, 24);
  const Mask all(ref.pixels.size(), 1);
  Image test = ref;
  EXPECT_EQ(fit_hint(ref, test, all), "");
  for (glm::vec3& t : test.pixels) t *= 3.1f;
  EXPECT_EQ(fit_hint(ref, test, all), "divided by pi");
  for (glm::vec3& t : test.pixels) t /= 3.1f * 3.1f;
  EXPECT_EQ(fit_hint(ref, test, all), "times pi");
  for (size_t i = 0; i < ref.pixels.size(); ++i) test.pixels[i] = ref.pixels[i / 32 * 32 + 31 - i % 32];
  EXPECT_EQ(fit_hint(ref, test, all), "flipped horizontally");
  for (size_t i = 0; i < ref.pixels.size(); ++i) test.pixels[i] = ref.pixels[(23 - i / 32) * 32 + i % 32];
  EXPECT_EQ(fit_hint(ref, test, all), "flipped vertically");
  EXPECT_EQ(fit_hint(ref, test, Mask(ref.pixels.size(), 0)), "") << "a sky is not compared";
  test.at(0, 0).x = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(fit_hint(ref, test, all), "");
}

// No figure of such a reference is over any limit: it must be refused.
TEST(Compare, ReferencesThatAreNotFiniteAreRefused) {
  const std::string path = ::testing::TempDir() + "volgi_reference_that_is_not_finite.exr";
  Image ref = ramp(8, 8);
  ref.at(3, 4).y = std::numeric_limits<float>::quiet_NaN();
  ref.at(5, 5).x = std::numeric_limits<float>::infinity();
  write_exr(path, ref);
  try {
    read_reference(path, PathTracerOptions::Light::full);
    ADD_FAILURE() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::bad_input);
    EXPECT_NE(std::string(error.what()).find("2 pixels of the reference are NaN"), std::string::npos) << error.what();
  }
  std::remove(path.c_str());
}

TEST(Compare, LargerPicturesAreBoxFiltered) {
  Image large(6, 4);
  for (size_t i = 0; i < large.pixels.size(); ++i) large.pixels[i] = glm::vec3(static_cast<float>(i));
  const Image small = box_downsample(large, 3, 2);
  EXPECT_EQ(small.at(0, 0).x, (0 + 1 + 6 + 7) / 4.0f);
  EXPECT_EQ(small.at(2, 1).x, (16 + 17 + 22 + 23) / 4.0f);
  EXPECT_THROW(box_downsample(large, 4, 4), Error);
  EXPECT_THROW(box_downsample(large, 12, 8), Error);
}

TEST(Compare, ErrorMapIsBlueWhereDarkAndRedWhereBright) {
  const Image ref(64, 64, glm::vec3(1.0f));
  Image test = ref;
  test.at(0, 0) *= 3.0f;
  test.at(1, 0) *= 0.0f;
  test.at(2, 0).x = std::numeric_limits<float>::quiet_NaN();
  const Image map = error_map(ref, test, Mask(64 * 64, 1));
  EXPECT_EQ(map.width, 256);
  EXPECT_EQ(map.at(0, 0), glm::vec3(1, 0, 0));
  EXPECT_EQ(map.at(4, 0), glm::vec3(0, 0, 1));
  EXPECT_EQ(map.at(8, 0), glm::vec3(1, 0, 1));
  EXPECT_EQ(map.at(12, 0), glm::vec3(1, 1, 1));
}

}  // namespace
}  // namespace volgi
