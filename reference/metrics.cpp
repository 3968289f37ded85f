#include "reference/metrics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "core/luminance.h"
#include "reference/ssim.h"

namespace volgi {
namespace {

constexpr int kBlock = 16;
constexpr int kMinPixelsInBlock = 32;

double channel_mean(glm::dvec3 c) { return (c.x + c.y + c.z) / 3.0; }
bool finite(glm::vec3 c) { return std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z); }

struct Means {
  glm::dvec3 ref{0.0}, test{0.0};
};

Means region_means(const Image& ref, const Image& test, const Mask& mask, int pixels) {
  Means sum;
  for (size_t i = 0; i < mask.size(); ++i) {
    if (mask[i] == 0) continue;
    sum.ref += glm::dvec3(ref.pixels[i]);
    sum.test += glm::dvec3(test.pixels[i]);
  }
  return {sum.ref / static_cast<double>(pixels), sum.test / static_cast<double>(pixels)};
}

void count_bad(Image& test, Metrics& m) {
  for (glm::vec3& t : test.pixels) {
    m.negative += t.x < 0 || t.y < 0 || t.z < 0;
    if (finite(t)) continue;
    ++m.nonfinite;
    for (int c = 0; c < 3; ++c)
      if (!std::isfinite(t[c])) t[c] = 0.0f;
  }
}

void measure_absolute(const Image& ref, const Image& test, const Mask& mask, Metrics& m) {
  double sum = 0;
  m.test_max = -std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < mask.size(); ++i) {
    if (mask[i] == 0) continue;
    const glm::dvec3 t(test.pixels[i]), e = glm::abs(t - glm::dvec3(ref.pixels[i]));
    sum += channel_mean(e);
    m.max_absolute = std::max({m.max_absolute, e.x, e.y, e.z});
    m.test_max = std::max({m.test_max, t.x, t.y, t.z});
  }
  m.mean_absolute = sum / m.pixels;
}

void measure_squares(const Image& ref, const Image& test, const Image* noise, const Mask& mask, const Metrics& m,
                     Metrics::Relative& out) {
  glm::dvec3 squares(0.0), weighted(0.0), noise_squares(0.0), noise_weighted(0.0), test_ref(0.0), test_test(0.0);
  const double floor = 0.1 * m.ref_mean * 0.1 * m.ref_mean;
  for (size_t i = 0; i < mask.size(); ++i) {
    if (mask[i] == 0) continue;
    const glm::dvec3 r(ref.pixels[i]), t(test.pixels[i]), e2 = (t - r) * (t - r), w = 1.0 / (r * r + floor);
    const glm::dvec3 n = noise != nullptr ? glm::dvec3(noise->pixels[i]) : glm::dvec3(0.0);
    squares += e2;
    weighted += e2 * w;
    noise_squares += n * n;
    noise_weighted += n * n * w;
    test_ref += t * r;
    test_test += t * t;
  }
  const auto mean = [&](glm::dvec3 sum) { return channel_mean(sum) / m.pixels; };
  out.rmse_pct = 100 * std::sqrt(mean(squares)) / m.ref_mean;
  out.relmse = mean(weighted);
  out.scale = channel_mean(test_ref) / std::max(channel_mean(test_test), 1e-30);
  if (noise == nullptr) return;
  out.rmse_pct_denoised = 100 * std::sqrt(std::max(0.0, mean(squares) - mean(noise_squares))) / m.ref_mean;
  out.relmse_denoised = mean(weighted) - mean(noise_weighted);
}

// numpy.percentile: linear between the two ranks.
double percentile(std::vector<double>& values, double percent) {
  std::sort(values.begin(), values.end());
  const double rank = percent / 100 * static_cast<double>(values.size() - 1);
  const size_t below = static_cast<size_t>(rank), above = std::min(below + 1, values.size() - 1);
  return values[below] + (rank - static_cast<double>(below)) * (values[above] - values[below]);
}

double p95_percent(const Image& ref, const Image& test, const Mask& mask, double mean_luminance) {
  std::vector<double> errors;
  for (size_t i = 0; i < mask.size(); ++i) {
    if (mask[i] == 0) continue;
    const double r = luminance(ref.pixels[i]), t = luminance(test.pixels[i]);
    const double base = std::max(r, 0.05 * mean_luminance);
    errors.push_back(base > 0 ? 100 * std::abs(t - r) / base : 0.0);
  }
  return percentile(errors, 95);
}

void measure_blocks(const Image& ref, const Image& test, const Mask& mask, double ref_mean, Metrics::Relative& out) {
  double squares = 0, sum = 0, largest = 0;
  int blocks = 0;
  for (int y0 = 0; y0 < ref.height; y0 += kBlock)
    for (int x0 = 0; x0 < ref.width; x0 += kBlock) {
      double r = 0, t = 0;
      int count = 0;
      for (int y = y0; y < std::min(y0 + kBlock, ref.height); ++y)
        for (int x = x0; x < std::min(x0 + kBlock, ref.width); ++x) {
          if (mask[static_cast<size_t>(y) * static_cast<size_t>(ref.width) + static_cast<size_t>(x)] == 0) continue;
          r += channel_mean(ref.at(x, y));
          t += channel_mean(test.at(x, y));
          ++count;
        }
      if (count < kMinPixelsInBlock) continue;
      const double q = (t - r) / (r + 0.1 * ref_mean * count);
      squares += q * q;
      sum += q;
      largest = std::max(largest, std::abs(q));
      ++blocks;
    }
  if (blocks == 0) return;
  out.blk_pct = 100 * std::sqrt(squares / blocks);
  out.blkmax_pct = 100 * largest;
  out.blkbias_pct = 100 * sum / blocks;
}

}  // namespace

Metrics measure(const Image& ref, const Image& test_as_given, const Image* noise, const Mask& mask) {
  assert(ref.width == test_as_given.width && ref.height == test_as_given.height && mask.size() == ref.pixels.size());
  Metrics m;
  Image test = test_as_given;
  count_bad(test, m);
  m.pixels = static_cast<int>(std::count_if(mask.begin(), mask.end(), [](char inside) { return inside != 0; }));
  if (m.pixels == 0) return m;
  const Means means = region_means(ref, test, mask, m.pixels);
  m.ref_mean = channel_mean(means.ref);
  m.test_mean = channel_mean(means.test);
  measure_absolute(ref, test, mask, m);
  if (!(m.ref_mean > 0)) return m;
  Metrics::Relative r;
  r.ratio = m.test_mean / m.ref_mean;
  for (int c = 0; c < 3; ++c) r.ratio_rgb[static_cast<size_t>(c)] = means.test[c] / std::max(means.ref[c], 1e-30);
  measure_squares(ref, test, noise, mask, m, r);
  r.p95_percent = p95_percent(ref, test, mask, luminance(means.ref));
  measure_blocks(ref, test, mask, m.ref_mean, r);
  r.ssim = ssim(ref, test, 0.35 / m.ref_mean, mask);
  m.relative = r;
  return m;
}

Image box_downsample(const Image& image, int width, int height) {
  if (image.width == width && image.height == height) return image;
  const int fx = image.width / width, fy = image.height / height;
  if (fx < 1 || fy < 1 || fx * width != image.width || fy * height != image.height)
    throw Error(ExitCode::bad_input,
                fmt::format("the picture is {}x{} and the reference {}x{}: render at the reference's "
                            "size or an integer multiple of it",
                            image.width, image.height, width, height));
  Image out(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      glm::dvec3 sum(0.0);
      for (int j = 0; j < fy; ++j)
        for (int i = 0; i < fx; ++i) sum += glm::dvec3(image.at(x * fx + i, y * fy + j));
      out.at(x, y) = glm::vec3(sum / static_cast<double>(fx * fy));
    }
  return out;
}

}  // namespace volgi
