#include "core/sky.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <numeric>
#include <span>
#include <utility>

#include "core/error.h"
#include "core/luminance.h"
#include "core/sample_sequence.h"

namespace volgi {
namespace {

constexpr double kPi = glm::pi<double>();

std::uint64_t next_id() {
  static std::atomic<std::uint64_t> last = 0;
  return ++last;
}

/// Of one texel of row y.
double texel_solid_angle_sr(const Image& image, int y) {
  return 2.0 * kPi / image.width * (std::cos(kPi * y / image.height) - std::cos(kPi * (y + 1) / image.height));
}

}  // namespace

Sky::Sky(glm::vec3 radiance)
    : image_(1, 1, radiance),
      integral_(4.0 * kPi * glm::dvec3(radiance)),
      id_(next_id()),
      name_(fmt::format("constant {:g} {:g} {:g}", radiance.x, radiance.y, radiance.z)) {}

Sky::Sky(Image latitude_longitude, float rotation_rad, std::string name)
    : image_(std::move(latitude_longitude)), id_(next_id()), rotation_rad_(rotation_rad), name_(std::move(name)) {
  for (int y = 0; y < image_.height; ++y) {
    glm::dvec3 row(0.0);
    for (int x = 0; x < image_.width; ++x) row += glm::dvec3(image_.at(x, y));
    integral_ += row * texel_solid_angle_sr(image_, y);
  }
}

glm::vec3 Sky::radiance(glm::vec3 towards) const {
  if (constant()) return image_.pixels[0];
  const glm::dvec3 d(towards);
  const double u = 0.5 + (std::atan2(d.x, -d.z) - double(rotation_rad_)) / (2.0 * kPi);
  const double v = std::acos(std::clamp(d.y, -1.0, 1.0)) / kPi;
  const double x = u * image_.width - 0.5, y = v * image_.height - 0.5;
  const double left = std::floor(x), top = std::floor(y);
  const auto texel = [&](double column, double row) {
    const int i = int(std::fmod(std::fmod(column, image_.width) + image_.width, image_.width));
    return image_.at(i, std::clamp(int(row), 0, image_.height - 1));
  };
  const float s = float(x - left), t = float(y - top);
  return glm::mix(glm::mix(texel(left, top), texel(left + 1, top), s),
                  glm::mix(texel(left, top + 1), texel(left + 1, top + 1), s), t);
}

glm::vec3 Sky::direction_at(double x, double y) const {
  const double azimuth = 2.0 * kPi * (x / image_.width - 0.5) + double(rotation_rad_), polar = kPi * y / image_.height;
  return glm::vec3(
      glm::dvec3(std::sin(polar) * std::sin(azimuth), std::cos(polar), -std::sin(polar) * std::cos(azimuth)));
}

Sky read_sky(const std::filesystem::path& file, float rotation_rad) {
  Image image = read_exr_rgb(file);
  if (image.width < 2 || image.width != 2 * image.height) {
    throw Error(ExitCode::bad_input,
                fmt::format("{}: {} x {} pixels: a sky is a latitude-longitude picture, twice as wide as high",
                            file.string(), image.width, image.height));
  }
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const glm::vec3 p = image.at(x, y);
      const bool fine = std::min({p.x, p.y, p.z}) >= 0.0f && std::isfinite(p.x + p.y + p.z);
      if (fine) continue;
      throw Error(ExitCode::bad_input, fmt::format("{}: the sky's pixel ({}, {}) is {} {} {}: radiance is finite and "
                                                   "not negative",
                                                   file.string(), x, y, p.x, p.y, p.z));
    }
  }
  return Sky(std::move(image), rotation_rad, file.filename().string());
}

// --- as lights ------------------------------------------------------------------------------------------------------

namespace {

std::vector<SkyLight> fibonacci_lights(glm::vec3 radiance, int count, std::uint64_t sample) {
  std::vector<SkyLight> lights;
  const double turn = 2.0 * kPi * sample_shift(SampleChoice::sky_azimuth, sample), step = place_in_strata(sample);
  const double golden = kPi * (3.0 - std::sqrt(5.0));
  const auto solid_angle = float(4.0 * kPi / count);
  for (int i = 0; i < count; ++i) {
    const double y = 1.0 - (2.0 * i + 2.0 * step) / count, r = std::sqrt(1.0 - y * y);
    const glm::dvec3 towards(r * std::sin(golden * i + turn), y, -r * std::cos(golden * i + turn));
    lights.push_back({glm::vec3(-towards), solid_angle, radiance * solid_angle});
  }
  return lights;
}

/// Sums of everything over boxes of texels: entry (x, y) is that of the texels above and left.
class SummedSky {
 public:
  struct Sum {
    glm::dvec3 irradiance{0.0}, towards{0.0};  // flux-weighted
    double solid_angle_sr = 0.0;
    Sum operator+(const Sum& o) const {
      return {irradiance + o.irradiance, towards + o.towards, solid_angle_sr + o.solid_angle_sr};
    }
    Sum operator-(const Sum& o) const {
      return {irradiance - o.irradiance, towards - o.towards, solid_angle_sr - o.solid_angle_sr};
    }
  };
  explicit SummedSky(const Sky& sky) : width_(sky.image().width), height_(sky.image().height) {
    sums_.resize(size_t(width_ + 1) * size_t(height_ + 1));
    for (int y = 0; y < height_; ++y) {
      const double dw = texel_solid_angle_sr(sky.image(), y);
      Sum row;
      for (int x = 0; x < width_; ++x) {
        const glm::dvec3 e = glm::dvec3(sky.image().at(x, y)) * dw;
        const double weight = luminance(e) + 1e-30 * dw;
        row = row + Sum{e, glm::dvec3(sky.direction_at(x + 0.5, y + 0.5)) * weight, dw};
        sums_[index(x + 1, y + 1)] = sums_[index(x + 1, y)] + row;
      }
    }
  }
  int width() const { return width_; }
  int height() const { return height_; }
  Sum over(glm::ivec4 box) const {  // x, y, end x, end y
    return (at(box.z, box.w) - at(box.x, box.w)) - (at(box.z, box.y) - at(box.x, box.y));
  }

 private:
  size_t index(int x, int y) const { return size_t(y) * size_t(width_ + 1) + size_t(x); }
  const Sum& at(int x, int y) const { return sums_[index(x, y)]; }
  int width_, height_;
  std::vector<Sum> sums_;
};

struct SkyPart {
  glm::ivec4 texels;  // x, y, end x, end y
  SkyLight light;
};

struct Box {
  glm::ivec4 texels;  // x, y, end x, end y
  double weight;
};

/// Halves the box across its longer edge on the sphere, where half of its weight is.
std::pair<glm::ivec4, glm::ivec4> halves(const SummedSky& sky, glm::ivec4 box, auto weight_of) {
  const double middle = kPi * 0.5 * (box.y + box.w) / sky.height();
  const double across = 2.0 * (box.z - box.x) * std::sin(middle) * sky.height() / sky.width(), down = box.w - box.y;
  const int axis = box.z - box.x > 1 && (across >= down || box.w - box.y == 1) ? 0 : 1;
  int low = box[axis] + 1, high = box[axis + 2] - 1;
  const double half = 0.5 * weight_of(box);
  while (low < high) {
    const int cut = (low + high) / 2;
    glm::ivec4 first = box;
    first[axis + 2] = cut;
    (weight_of(first) < half ? low : high) = weight_of(first) < half ? cut + 1 : cut;
  }
  // Of the two cuts around, the one that halves it better.
  glm::ivec4 before = box;
  before[axis + 2] = std::max(low - 1, box[axis] + 1);
  glm::ivec4 after = box;
  after[axis + 2] = low;
  glm::ivec4 first = std::abs(weight_of(before) - half) < std::abs(weight_of(after) - half) ? before : after;
  glm::ivec4 second = box;
  second[axis] = first[axis + 2];
  return {first, second};
}

std::vector<SkyPart> median_cut_parts(const Sky& sky, int count) {
  constexpr double kBySolidAngle = 0.25;
  const SummedSky sums(sky);
  const glm::ivec4 all(0, 0, sums.width(), sums.height());
  const double total = luminance(sums.over(all).irradiance);
  const auto weight_of = [&](glm::ivec4 box) {
    const SummedSky::Sum s = sums.over(box);
    const double by_flux = total > 0.0 ? luminance(s.irradiance) / total : 0.0;
    return (1.0 - kBySolidAngle) * by_flux + kBySolidAngle * s.solid_angle_sr / (4.0 * kPi);
  };
  const auto lighter = [](const Box& a, const Box& b) { return a.weight < b.weight; };
  std::vector<Box> heap{{all, 1.0}};
  std::vector<Box> whole;  // single texels
  while (int(heap.size() + whole.size()) < count && !heap.empty()) {
    std::pop_heap(heap.begin(), heap.end(), lighter);
    const Box box = heap.back();
    heap.pop_back();
    if (box.texels.z - box.texels.x == 1 && box.texels.w - box.texels.y == 1) {
      whole.push_back(box);
      continue;
    }
    const auto [first, second] = halves(sums, box.texels, weight_of);
    for (const glm::ivec4 half : {first, second}) {
      heap.push_back({half, weight_of(half)});
      std::push_heap(heap.begin(), heap.end(), lighter);
    }
  }
  heap.insert(heap.end(), whole.begin(), whole.end());
  std::vector<SkyPart> parts;
  for (const Box& box : heap) {
    const SummedSky::Sum s = sums.over(box.texels);
    parts.push_back({box.texels,
                     {-glm::vec3(glm::normalize(s.towards)), float(s.solid_angle_sr),
                      glm::max(glm::vec3(s.irradiance), glm::vec3(0.0f))}});
  }
  std::stable_sort(parts.begin(), parts.end(),
                   [](const SkyPart& a, const SkyPart& b) { return a.light.direction.y < b.light.direction.y; });
  return parts;
}

/// Index of the weight that `at` of all of them together meets; `at` is then how far into it, both in [0, 1).
int choose(std::span<const double> weights, double& at) {
  double left = at * std::accumulate(weights.begin(), weights.end(), 0.0);
  size_t k = 0;
  while (k + 1 < weights.size() && left >= weights[k]) left -= weights[k++];
  at = weights[k] > 0.0 ? std::clamp(left / weights[k], 0.0, 1.0) : 0.5;
  return int(k);
}

/// Where in the box a place of the unit square lies, by the light that comes from there.
glm::vec3 direction_in_box(const Sky& sky, glm::ivec4 box, glm::dvec2 at) {
  const auto weight = [&](int x, int y) {
    return (double(luminance(glm::dvec3(sky.image().at(x, y)))) + 1e-30) * texel_solid_angle_sr(sky.image(), y);
  };
  std::vector<double> rows, columns;
  for (int y = box.y; y < box.w; ++y) {
    double row = 0.0;
    for (int x = box.x; x < box.z; ++x) row += weight(x, y);
    rows.push_back(row);
  }
  const int y = box.y + choose(rows, at.y);
  for (int x = box.x; x < box.z; ++x) columns.push_back(weight(x, y));
  const int x = box.x + choose(columns, at.x);
  return sky.direction_at(x + at.x, y + at.y);
}

}  // namespace

std::vector<SkyLight> sky_lights(const Sky& sky, int count) {
  if (sky.constant()) return fibonacci_lights(sky.image().pixels[0], count, 0);
  std::vector<SkyLight> lights;
  for (const SkyPart& part : median_cut_parts(sky, count)) lights.push_back(part.light);
  return lights;
}

SkyParts::SkyParts(std::shared_ptr<const Sky> sky, int count) : sky_(std::move(sky)), count_(count) {
  if (sky_->constant()) return;
  for (const SkyPart& part : median_cut_parts(*sky_, count)) {
    boxes_.push_back(part.texels);
    lights_.push_back(part.light);
  }
}

std::vector<SkyLight> SkyParts::lights(int sample) const {
  const auto k = std::uint64_t(sample);
  if (sky_->constant()) return fibonacci_lights(sky_->image().pixels[0], count_, k);
  std::vector<SkyLight> lights = lights_;
  if (sample == 0) return lights;
  const glm::dvec2 moved(sample_shift(SampleChoice::sky_azimuth, k), place_in_strata(k));
  for (size_t i = 0; i < lights.size(); ++i) {  // Halton's points, so that boxes do not all look the same way
    const glm::dvec2 at = glm::fract(halton(i + 1) + moved);
    lights[i].direction = -direction_in_box(*sky_, boxes_[i], at);
  }
  return lights;
}

// --- the analytic one -----------------------------------------------------------------------------------------------

namespace {

double radians_between(glm::dvec3 a, glm::dvec3 b) { return std::acos(std::clamp(glm::dot(a, b), -1.0, 1.0)); }

glm::dvec3 towards_sun(double elevation_rad, double azimuth_rad) {
  return {std::cos(elevation_rad) * std::sin(azimuth_rad), std::sin(elevation_rad),
          -std::cos(elevation_rad) * std::cos(azimuth_rad)};
}

/// Preetham et al. 1999, appendix A: Perez' distribution of luminance and chromaticity, by turbidity.
class Perez {
 public:
  Perez(double turbidity, double sun_zenith_rad) : sun_zenith_(sun_zenith_rad) {
    const double t = turbidity;
    coefficients_[0] = {0.1787 * t - 1.4630, -0.3554 * t + 0.4275, -0.0227 * t + 5.3251, 0.1206 * t - 2.5771,
                        -0.0670 * t + 0.3703};
    coefficients_[1] = {-0.0193 * t - 0.2592, -0.0665 * t + 0.0008, -0.0004 * t + 0.2125, -0.0641 * t - 0.8989,
                        -0.0033 * t + 0.0452};
    coefficients_[2] = {-0.0167 * t - 0.2608, -0.0950 * t + 0.0092, -0.0079 * t + 0.2102, -0.0441 * t - 1.6537,
                        -0.0109 * t + 0.0529};
    const double s = sun_zenith_, s2 = s * s, s3 = s2 * s;
    const double chi = (4.0 / 9.0 - t / 120.0) * (kPi - 2.0 * s);
    zenith_.x = 1000.0 * ((4.0453 * t - 4.9710) * std::tan(chi) - 0.2155 * t + 2.4192);  // cd/m^2
    zenith_.y = (0.00166 * s3 - 0.00375 * s2 + 0.00209 * s) * t * t +
                (-0.02903 * s3 + 0.06377 * s2 - 0.03202 * s + 0.00394) * t +
                (0.11693 * s3 - 0.21196 * s2 + 0.06052 * s + 0.25886);
    zenith_.z = (0.00275 * s3 - 0.00610 * s2 + 0.00317 * s) * t * t +
                (-0.04214 * s3 + 0.08970 * s2 - 0.04153 * s + 0.00516) * t +
                (0.15346 * s3 - 0.26756 * s2 + 0.06670 * s + 0.26688);
  }
  /// Linear Rec. 709 whose luminance is that of the model [cd/m^2].
  glm::dvec3 radiance(double zenith_angle, double to_sun) const {
    const double cosine = std::max(std::cos(zenith_angle), 0.01);
    const double y = std::max(value(0, cosine, to_sun), 0.0), cx = value(1, cosine, to_sun),
                 cy = value(2, cosine, to_sun);
    const double x = cx / cy * y, z = (1.0 - cx - cy) / cy * y;
    const glm::dvec3 rgb(3.2404542 * x - 1.5371385 * y - 0.4985314 * z, -0.9692660 * x + 1.8760108 * y + 0.0415560 * z,
                         0.0556434 * x - 0.2040259 * y + 1.0572252 * z);
    return glm::max(rgb, glm::dvec3(0.0));
  }

 private:
  double value(int k, double cosine, double to_sun) const {
    const auto f = [&](double cos_zenith, double gamma) {
      const auto& c = coefficients_[k];
      const double g = std::cos(gamma);
      return (1.0 + c[0] * std::exp(c[1] / cos_zenith)) * (1.0 + c[2] * std::exp(c[3] * gamma) + c[4] * g * g);
    };
    return zenith_[k] * f(cosine, to_sun) / f(1.0, sun_zenith_);
  }
  double sun_zenith_;
  std::array<double, 5> coefficients_[3];
  glm::dvec3 zenith_;
};

}  // namespace

Sky clear_sky(double elevation_rad, double azimuth_rad, double turbidity) {
  constexpr int kHeight = 128;
  const double above = std::max(elevation_rad, 0.0);
  const Perez perez(turbidity, 0.5 * kPi - above);
  const glm::dvec3 sun = towards_sun(above, azimuth_rad);
  Sky sky(Image(2 * kHeight, kHeight), 0.0f,
          fmt::format("sun:{:g},{:g},{:g}", glm::degrees(elevation_rad), glm::degrees(azimuth_rad), turbidity));
  Image image = sky.image();
  glm::dvec3 on_ground =
      glm::dvec3(sun_of_clear_sky(elevation_rad, azimuth_rad, turbidity).intensity) * std::max(sun.y, 0.0);
  for (int y = 0; y < kHeight / 2; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const glm::dvec3 d(sky.direction_at(x + 0.5, y + 0.5));
      const glm::dvec3 radiance = perez.radiance(std::acos(d.y), radians_between(d, sun));
      image.at(x, y) = glm::vec3(radiance);
      on_ground += radiance * (d.y * texel_solid_angle_sr(image, y));
    }
  }
  constexpr double kGroundAlbedo = 0.2;
  std::fill(image.pixels.begin() + std::ptrdiff_t(image.pixels.size() / 2), image.pixels.end(),
            glm::vec3(on_ground * (kGroundAlbedo / kPi)));
  return Sky(std::move(image), 0.0f, sky.name());
}

Light sun_of_clear_sky(double elevation_rad, double azimuth_rad, double turbidity) {
  constexpr double kAboveAir_lx = 128000.0;
  Light sun;
  sun.name = "sun";
  sun.type = Light::Type::directional;
  sun.direction = -glm::vec3(towards_sun(elevation_rad, azimuth_rad));
  if (!(elevation_rad > 0.0)) return sun;
  // Relative air mass (Kasten and Young 1989); extinction by molecules (Rayleigh, lambda^-4.08) and haze (Angstrom,
  // lambda^-1.3, beta = 0.0461 T - 0.0459 as Preetham has it) at 610, 550 and 465 nm.
  const double mass =
      1.0 / (std::sin(elevation_rad) + 0.50572 * std::pow(glm::degrees(elevation_rad) + 6.07995, -1.6364));
  const double beta = std::max(0.04608365822050 * turbidity - 0.04586025928522, 0.0);
  const double micrometres[3] = {0.61, 0.55, 0.465};
  for (int band = 0; band < 3; ++band) {
    const double depth = 0.008735 * std::pow(micrometres[band], -4.08) + beta * std::pow(micrometres[band], -1.3);
    sun.intensity[band] = float(kAboveAir_lx * std::exp(-depth * mass));
  }
  return sun;
}

}  // namespace volgi
