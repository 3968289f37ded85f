#include "reference/ssim.h"

#include "core/luminance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace volgi {
namespace {

// Double throughout; core's srgb_encode() is single precision.
struct Plane {
  int width = 0, height = 0;
  std::vector<double> values;
  double& at(int x, int y) {
    return values[static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x)];
  }
  double at(int x, int y) const {
    return values[static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x)];
  }
};

Plane make_plane(int width, int height) {
  return {width, height, std::vector<double>(static_cast<size_t>(width) * static_cast<size_t>(height))};
}

double srgb(double x) {
  x = std::clamp(x, 0.0, 1.0);
  return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
}

Plane encoded_half_size(const Image& image, double exposure) {
  Plane out = make_plane(image.width / 2, image.height / 2);
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x) {
      const double sum = luminance(image.at(2 * x, 2 * y)) + luminance(image.at(2 * x, 2 * y + 1)) +
                         luminance(image.at(2 * x + 1, 2 * y)) + luminance(image.at(2 * x + 1, 2 * y + 1));
      out.at(x, y) = srgb(sum / 4 * exposure);
    }
  return out;
}

// The edge pixel itself is not repeated (numpy's "reflect").
int reflect(int i, int n) {
  if (n == 1) return 0;
  const int period = 2 * (n - 1);
  i = ((i % period) + period) % period;
  return i < n ? i : period - i;
}

Plane gauss(const Plane& in) {
  std::array<double, 11> kernel{};
  double sum = 0;
  for (int i = 0; i < 11; ++i) sum += kernel[static_cast<size_t>(i)] = std::exp(-0.5 * (i - 5) * (i - 5) / (1.5 * 1.5));
  for (double& k : kernel) k /= sum;
  Plane down = make_plane(in.width, in.height), out = down;
  for (int y = 0; y < in.height; ++y)
    for (int i = 0; i < 11; ++i)
      for (int x = 0; x < in.width; ++x)
        down.at(x, y) += kernel[static_cast<size_t>(i)] * in.at(x, reflect(y + i - 5, in.height));
  for (int y = 0; y < in.height; ++y)
    for (int x = 0; x < in.width; ++x)
      for (int i = 0; i < 11; ++i)
        out.at(x, y) += kernel[static_cast<size_t>(i)] * down.at(reflect(x + i - 5, in.width), y);
  return out;
}

Plane product(const Plane& a, const Plane& b) {
  Plane out = a;
  for (size_t i = 0; i < out.values.size(); ++i) out.values[i] *= b.values[i];
  return out;
}

}  // namespace

double ssim(const Image& ref, const Image& test, double exposure, const Mask& mask) {
  const Plane a = encoded_half_size(ref, exposure), b = encoded_half_size(test, exposure);
  if (a.values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const Plane mean_a = gauss(a), mean_b = gauss(b);
  const Plane aa = gauss(product(a, a)), bb = gauss(product(b, b)), ab = gauss(product(a, b));
  const auto inside = [&](int x, int y) {
    return mask[static_cast<size_t>(y) * static_cast<size_t>(ref.width) + static_cast<size_t>(x)] != 0 ? 1 : 0;
  };
  double sum = 0;
  int count = 0;
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x) {
      if (inside(2 * x, 2 * y) + inside(2 * x + 1, 2 * y) + inside(2 * x, 2 * y + 1) + inside(2 * x + 1, 2 * y + 1) < 3)
        continue;
      const double ma = mean_a.at(x, y), mb = mean_b.at(x, y);
      const double va = aa.at(x, y) - ma * ma, vb = bb.at(x, y) - mb * mb, covariance = ab.at(x, y) - ma * mb;
      sum += (2 * ma * mb + 1e-4) * (2 * covariance + 9e-4) / ((ma * ma + mb * mb + 1e-4) * (va + vb + 9e-4));
      ++count;
    }
  return count > 0 ? sum / count : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace volgi
