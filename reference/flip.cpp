#include "reference/flip.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numbers>

namespace volgi {
namespace {

constexpr double kPi = std::numbers::pi;

/// sRGB's primaries and D65, to XYZ; rows.
const glm::dmat3& xyz_from_linear() {
  static const glm::dmat3 m =
      glm::transpose(glm::dmat3(10135552.0 / 24577794.0, 8788810.0 / 24577794.0, 4435075.0 / 24577794.0,  //
                                2613072.0 / 12288897.0, 8788810.0 / 12288897.0, 887015.0 / 12288897.0,    //
                                1425312.0 / 73733382.0, 8788810.0 / 73733382.0, 70074185.0 / 73733382.0));
  return m;
}
glm::dvec3 white() { return xyz_from_linear() * glm::dvec3(1.0); }

/// The opponent space in which contrast is filtered: linear, luminance, red-green, blue-yellow.
glm::dvec3 ycxcz_from_linear(glm::dvec3 rgb) {
  const glm::dvec3 t = xyz_from_linear() * rgb / white();
  return {116.0 * t.y - 16.0, 500.0 * (t.x - t.y), 200.0 * (t.y - t.z)};
}
glm::dvec3 linear_from_ycxcz(glm::dvec3 c) {
  static const glm::dmat3 linear_from_xyz = glm::inverse(xyz_from_linear());
  const double y = (c.x + 16.0) / 116.0;
  return linear_from_xyz * (glm::dvec3(y + c.y / 500.0, y, y - c.z / 200.0) * white());
}

glm::dvec3 lab_from_linear(glm::dvec3 rgb) {
  constexpr double delta = 6.0 / 29.0;
  const auto f = [](double t) {
    return t > delta * delta * delta ? std::cbrt(t) : t / (3.0 * delta * delta) + 4.0 / 29.0;
  };
  const glm::dvec3 t = xyz_from_linear() * rgb / white();
  return {116.0 * f(t.y) - 16.0, 500.0 * (f(t.x) - f(t.y)), 200.0 * (f(t.y) - f(t.z))};
}
/// After Hunt: dark colours are less colourful.
glm::dvec3 hunt(glm::dvec3 lab) { return {lab.x, 0.01 * lab.x * lab.y, 0.01 * lab.x * lab.z}; }

double hyab(glm::dvec3 a, glm::dvec3 b) { return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z); }

struct Plane {
  int width, height;
  std::vector<double> values;
};

using Kernel = std::vector<double>;  // of -r ... r

/// Rows by one kernel, then columns by another; outside the picture its edge goes on.
Plane filtered(const Plane& in, const Kernel& along_x, const Kernel& along_y) {
  const int r = int(along_x.size()) / 2;
  Plane across = in, out = in;
  tbb::parallel_for(0, in.height, [&](int y) {
    const double* row = in.values.data() + size_t(y) * size_t(in.width);
    for (int x = 0; x < in.width; ++x) {
      double sum = 0.0;
      for (int k = 0; k <= 2 * r; ++k) sum += along_x[size_t(k)] * row[std::clamp(x + k - r, 0, in.width - 1)];
      across.values[size_t(y) * size_t(in.width) + size_t(x)] = sum;
    }
  });
  tbb::parallel_for(0, in.height, [&](int y) {
    for (int x = 0; x < in.width; ++x) {
      double sum = 0.0;
      for (int k = 0; k <= 2 * r; ++k)
        sum += along_y[size_t(k)] *
               across.values[size_t(std::clamp(y + k - r, 0, in.height - 1)) * size_t(in.width) + size_t(x)];
      out.values[size_t(y) * size_t(in.width) + size_t(x)] = sum;
    }
  });
  return out;
}

/// Contrast sensitivity of the three channels: sums of two Gaussians of the angle (table 1 of the paper).
struct Sensitivity {
  double a1, b1, a2, b2;
};
constexpr std::array<Sensitivity, 3> SENSITIVITIES{
    {{1.0, 0.0047, 0.0, 1e-5}, {1.0, 0.0053, 0.0, 1e-5}, {34.1, 0.04, 13.5, 0.025}}};

Plane contrast_filtered(const Plane& in, const Sensitivity& s, double pixels_per_degree) {
  constexpr double widest = 0.04;  // b of the widest Gaussian: all kernels have its radius
  const int r = int(std::ceil(3.0 * std::sqrt(widest / (2.0 * kPi * kPi)) * pixels_per_degree));
  Plane sum = in;
  std::fill(sum.values.begin(), sum.values.end(), 0.0);
  double whole = 0.0;
  for (const auto& [a, b] : {std::pair(s.a1, s.b1), std::pair(s.a2, s.b2)}) {
    if (a == 0.0) continue;
    Kernel kernel;
    double kernel_sum = 0.0;
    for (int k = -r; k <= r; ++k) {
      const double angle = k / pixels_per_degree;
      kernel.push_back(std::exp(-kPi * kPi * angle * angle / b));
      kernel_sum += kernel.back();
    }
    const double weight = a * std::sqrt(kPi / b);
    whole += weight * kernel_sum * kernel_sum;
    const Plane part = filtered(in, kernel, kernel);
    for (size_t i = 0; i < sum.values.size(); ++i) sum.values[i] += weight * part.values[i];
  }
  for (double& v : sum.values) v /= whole;
  return sum;
}

/// A picture in the opponent space.
struct Opponent {
  std::array<Plane, 3> planes;
};
Opponent opponent_of(const Image& image) {
  Opponent out{{Plane{image.width, image.height, std::vector<double>(image.pixels.size())},
                Plane{image.width, image.height, std::vector<double>(image.pixels.size())},
                Plane{image.width, image.height, std::vector<double>(image.pixels.size())}}};
  for (size_t i = 0; i < image.pixels.size(); ++i) {
    const glm::dvec3 c = ycxcz_from_linear(glm::dvec3(image.pixels[i]));
    for (int k = 0; k < 3; ++k) out.planes[size_t(k)].values[i] = c[k];
  }
  return out;
}

/// What the eye sees of it, in Lab after Hunt.
std::vector<glm::dvec3> seen(const Opponent& picture, double pixels_per_degree) {
  std::array<Plane, 3> planes = picture.planes;
  for (size_t k = 0; k < 3; ++k) planes[k] = contrast_filtered(planes[k], SENSITIVITIES[k], pixels_per_degree);
  std::vector<glm::dvec3> out;
  out.reserve(planes[0].values.size());
  for (size_t i = 0; i < planes[0].values.size(); ++i) {
    const glm::dvec3 rgb = linear_from_ycxcz({planes[0].values[i], planes[1].values[i], planes[2].values[i]});
    out.push_back(hunt(lab_from_linear(glm::clamp(rgb, 0.0, 1.0))));
  }
  return out;
}

/// Differences of colour in [0, 1]: those up to 0.4 of the largest that there can be fill 95 %.
double color_difference(glm::dvec3 a, glm::dvec3 b) {
  constexpr double qc = 0.7, pc = 0.4, pt = 0.95;
  static const double largest =
      std::pow(hyab(hunt(lab_from_linear({0.0, 1.0, 0.0})), hunt(lab_from_linear({0.0, 0.0, 1.0}))), qc);
  const double d = std::pow(hyab(a, b), qc), knee = pc * largest;
  return d < knee ? pt / knee * d : pt + (d - knee) / (largest - knee) * (1.0 - pt);
}

/// Positive weights sum to 1, negative ones to -1.
void normalize_signs(Kernel& kernel) {
  double positive = 0.0, negative = 0.0;
  for (const double w : kernel) (w > 0.0 ? positive : negative) += std::abs(w);
  for (double& w : kernel) w /= w > 0.0 ? positive : std::max(negative, 1e-300);
}

struct Features {
  std::vector<double> edges, points;  // lengths of gradients, and of second derivatives
};
Features features_of(const Plane& luminance, double pixels_per_degree) {
  constexpr double width_deg = 0.082;
  const double deviation = 0.5 * width_deg * pixels_per_degree;
  const int r = int(std::ceil(3.0 * deviation));
  Kernel smooth, edge, point;
  double sum = 0.0;
  for (int k = -r; k <= r; ++k) {
    const double g = std::exp(-k * k / (2.0 * deviation * deviation));
    smooth.push_back(g);
    sum += g;
    edge.push_back(-k * g);
    point.push_back((k * k / (deviation * deviation) - 1.0) * g);
  }
  for (double& w : smooth) w /= sum;
  normalize_signs(edge);
  normalize_signs(point);
  Plane y = luminance;
  for (double& v : y.values) v = (v + 16.0) / 116.0;
  const auto lengths = [&](const Kernel& derivative) {
    const Plane dx = filtered(y, derivative, smooth), dy = filtered(y, smooth, derivative);
    std::vector<double> out;
    out.reserve(dx.values.size());
    for (size_t i = 0; i < dx.values.size(); ++i) out.push_back(std::hypot(dx.values[i], dy.values[i]));
    return out;
  };
  return {lengths(edge), lengths(point)};
}

/// ACES' curve as HDR-FLIP has it, with its exposure of 0.6.
constexpr double K0 = 0.6 * 0.6 * 2.51, K1 = 0.6 * 0.03, K2 = 0.0, K3 = 0.6 * 0.6 * 2.43, K4 = 0.6 * 0.59, K5 = 0.14;

Image tone_mapped(const Image& image, double ev) {
  Image out(image.width, image.height);
  const double scale = std::exp2(ev);
  for (size_t i = 0; i < image.pixels.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      const double v = double(image.pixels[i][c]), x = std::isfinite(v) && v > 0.0 ? scale * v : 0.0;
      out.pixels[i][c] = float(std::clamp((K0 * x * x + K1 * x + K2) / (K3 * x * x + K4 * x + K5), 0.0, 1.0));
    }
  }
  return out;
}

/// Where the curve reaches 0.85.
double bright_end() {
  constexpr double t = 0.85, a = K0 - t * K3, b = K1 - t * K4, c = K2 - t * K5;
  const double root = std::sqrt(b * b - 4.0 * a * c);
  return std::max((-b + root) / (2.0 * a), (-b - root) / (2.0 * a));
}

}  // namespace

double FlipMap::mean(const Mask& mask) const {
  double sum = 0.0;
  size_t count = 0;
  for (size_t i = 0; i < values.size(); ++i) {
    if (mask[i] == 0) continue;
    sum += double(values[i]);
    ++count;
  }
  return count > 0 ? sum / double(count) : 0.0;
}

FlipMap flip_ldr(const Image& reference, const Image& test, const FlipOptions& options) {
  assert(reference.width == test.width && reference.height == test.height);
  const double ppd = options.pixels_per_degree;
  const Opponent a = opponent_of(reference), b = opponent_of(test);
  const std::vector<glm::dvec3> seen_a = seen(a, ppd), seen_b = seen(b, ppd);
  const Features features_a = features_of(a.planes[0], ppd), features_b = features_of(b.planes[0], ppd);
  FlipMap out;
  out.values.reserve(seen_a.size());
  for (size_t i = 0; i < seen_a.size(); ++i) {
    const double feature = std::sqrt(std::max(std::abs(features_a.edges[i] - features_b.edges[i]),
                                              std::abs(features_a.points[i] - features_b.points[i])) /
                                     std::numbers::sqrt2);
    out.values.push_back(float(std::pow(color_difference(seen_a[i], seen_b[i]), 1.0 - feature)));
  }
  return out;
}

std::optional<FlipMap> flip_hdr(const Image& reference, const Image& test, const FlipOptions& options) {
  std::vector<double> luminances;
  for (const glm::vec3& p : reference.pixels) {
    const double y = (xyz_from_linear() * glm::dvec3(p)).y;
    if (std::isfinite(y) && y > 0.0) luminances.push_back(y);
  }
  if (luminances.empty()) return std::nullopt;
  std::sort(luminances.begin(), luminances.end());
  const size_t n = luminances.size();
  const double median = n % 2 == 1 ? luminances[n / 2] : 0.5 * (luminances[n / 2 - 1] + luminances[n / 2]);
  const double start = std::log2(bright_end() / luminances.back()), stop = std::log2(bright_end() / median);
  constexpr int most = 64;  // of what lies further apart than any picture
  const int count = std::clamp(int(std::ceil(stop - start)), 2, most);
  FlipMap out;
  for (int k = 0; k < count; ++k) {
    const double ev = start + (stop - start) * k / (count - 1);
    const FlipMap at = flip_ldr(tone_mapped(reference, ev), tone_mapped(test, ev), options);
    if (out.values.empty()) out.values = at.values;
    for (size_t i = 0; i < out.values.size(); ++i) out.values[i] = std::max(out.values[i], at.values[i]);
  }
  out.exposures = count;
  out.start_ev = start;
  out.stop_ev = stop;
  return out;
}

}  // namespace volgi
