#include "reference/sky_sampler.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "core/luminance.h"

namespace volgi {
namespace {

constexpr double kPi = glm::pi<double>();

/// Mean luminance of a texel under bilinear interpolation of the middles: weights 1/8, 6/8, 1/8 on either axis.
double luminance_in(const Image& image, int x, int y) {
  constexpr double kWeight[3] = {0.125, 0.75, 0.125};
  double sum = 0.0;
  for (int j = -1; j <= 1; ++j)
    for (int i = -1; i <= 1; ++i)
      sum +=
          kWeight[i + 1] * kWeight[j + 1] *
          luminance(glm::dvec3(image.at((x + i + image.width) % image.width, std::clamp(y + j, 0, image.height - 1))));
  return sum;
}

/// The first entry above xi in a rising row that ends at 1, and xi stretched over what it chose.
size_t choose(const double* cumulative, int count, float& xi) {
  const double* found = std::upper_bound(cumulative, cumulative + count, double(xi));
  const size_t i = std::min(size_t(found - cumulative), size_t(count - 1));
  const double below = i > 0 ? cumulative[i - 1] : 0.0, width = cumulative[i] - below;
  xi = width > 0.0 ? float(std::clamp((double(xi) - below) / width, 0.0, 1.0)) : 0.5f;
  return i;
}

}  // namespace

SkySampler::SkySampler(const Sky& sky) : sky_(sky), width_(sky.image().width), height_(sky.image().height) {
  const Image& image = sky.image();
  const size_t count = size_t(width_) * size_t(height_);
  rows_.resize(size_t(height_));
  columns_.resize(count);
  texels_.resize(count);
  double total = 0.0;
  for (int y = 0; y < height_; ++y) {
    const double dw = std::cos(kPi * y / height_) - std::cos(kPi * (y + 1) / height_);
    double row = 0.0;
    for (int x = 0; x < width_; ++x) columns_[index(x, y)] = row += luminance_in(image, x, y) * dw;
    for (int x = 0; x < width_ && row > 0.0; ++x) columns_[index(x, y)] /= row;
    rows_[size_t(y)] = total += row;
  }
  if (!(total > 0.0)) return;
  for (double& r : rows_) r /= total;
  for (int y = 0; y < height_; ++y) {
    const double row = rows_[size_t(y)] - (y > 0 ? rows_[size_t(y - 1)] : 0.0);
    for (int x = 0; x < width_; ++x) {
      const size_t i = index(x, y);
      texels_[i] = float(row * (columns_[i] - (x > 0 ? columns_[i - 1] : 0.0)));
    }
  }
}

float SkySampler::texel_pdf(size_t texel) const {
  const size_t row = texel / size_t(width_);
  const auto y = double(row);
  const double dw = 2.0 * kPi / width_ * (std::cos(kPi * y / height_) - std::cos(kPi * (y + 1.0) / height_));
  return float(texels_[texel] / dw);
}

SkySample SkySampler::sample(glm::vec2 xi) const {
  if (!(rows_.back() > 0.0)) return {};
  const size_t y = choose(rows_.data(), height_, xi.y);
  const size_t x = choose(columns_.data() + y * size_t(width_), width_, xi.x);
  // Even over the texel's solid angle: in the cosine of the polar angle.
  const double top = std::cos(kPi * double(y) / height_), bottom = std::cos(kPi * double(y + 1) / height_);
  const double polar = std::acos(std::clamp(top + (bottom - top) * double(xi.y), -1.0, 1.0));
  const glm::vec3 towards = sky_.direction_at(double(x) + double(xi.x), polar / kPi * height_);
  return {towards, sky_.radiance(towards), texel_pdf(y * size_t(width_) + x)};
}

float SkySampler::pdf(glm::vec3 towards) const {
  const double u =
      0.5 + (std::atan2(double(towards.x), -double(towards.z)) - double(sky_.rotation_rad())) / (2.0 * kPi);
  const double v = std::acos(std::clamp(double(towards.y), -1.0, 1.0)) / kPi;
  const int x = std::min(int((u - std::floor(u)) * width_), width_ - 1), y = std::min(int(v * height_), height_ - 1);
  return texel_pdf(size_t(y) * size_t(width_) + size_t(x));
}

}  // namespace volgi
