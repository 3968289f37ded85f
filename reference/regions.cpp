// Regions of compare.py, line for line.
#include <algorithm>
#include <cmath>

#include "reference/metrics.h"

namespace volgi {
namespace {

constexpr std::array<std::string_view, 6> kNames{"all", "hit", "noedge", "shadow", "lit", "shade"};

// Calls f(neighbour) for the 8 around a pixel; outside the picture its edge is repeated.
template <class F>
void for_neighbours(int x, int y, int width, int height, F f) {
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx) {
      if (dx == 0 && dy == 0) continue;
      const int nx = std::clamp(x + dx, 0, width - 1), ny = std::clamp(y + dy, 0, height - 1);
      f(static_cast<size_t>(ny) * static_cast<size_t>(width) + static_cast<size_t>(nx));
    }
}

bool smooth_geometry(const RegionLayers& l, int x, int y, size_t i) {
  const glm::dvec3 normal(l.normal.pixels[i]), position(l.position.pixels[i]);
  const double near_plane = 0.03 * std::max(static_cast<double>(l.depth[i]), 1e-9);
  bool smooth = true;
  for_neighbours(x, y, l.normal.width, l.normal.height, [&](size_t q) {
    smooth = smooth && std::round(l.id[q]) == std::round(l.id[i]) &&
             glm::dot(glm::dvec3(l.normal.pixels[q]), normal) > 0.9 &&
             std::abs(glm::dot(glm::dvec3(l.position.pixels[q]) - position, normal)) < near_plane;
  });
  return smooth;
}

// Least and largest direct light of a pixel and its neighbours. Single precision, as numpy's.
struct DirectRange {
  float low, high;
};

DirectRange direct_range(const Image& direct, int x, int y) {
  const auto sum = [](glm::vec3 c) { return c.x + c.y + c.z; };
  DirectRange range{sum(direct.at(x, y)), sum(direct.at(x, y))};
  for_neighbours(x, y, direct.width, direct.height, [&](size_t q) {
    range.low = std::min(range.low, sum(direct.pixels[q]));
    range.high = std::max(range.high, sum(direct.pixels[q]));
  });
  return range;
}

// Differences of direct light up to this are noise: five times the RMS over 5x5 pixels.
double noise_tolerance(const Image& noise, int x, int y) {
  double squares = 0;
  for (int dy = -2; dy <= 2; ++dy)
    for (int dx = -2; dx <= 2; ++dx) {
      const glm::dvec3 n(noise.at(std::clamp(x + dx, 0, noise.width - 1), std::clamp(y + dy, 0, noise.height - 1)));
      squares += (n.x + n.y + n.z) * (n.x + n.y + n.z);
    }
  return 5 * std::sqrt(squares / 25);
}

bool shadow_edge(const RegionLayers& l, int x, int y, size_t i, DirectRange direct) {
  double tolerance = 0.35f * std::max(direct.high, 1e-12f);
  bool other_lights = false;
  if (!l.lit.empty()) {
    tolerance += noise_tolerance(l.direct_noise, x, y);
    for_neighbours(x, y, l.direct.width, l.direct.height,
                   [&](size_t q) { other_lights = other_lights || std::round(l.lit[q]) != std::round(l.lit[i]); });
  }
  return other_lights || direct.high - direct.low > tolerance;
}

bool in_region(Region region, const RegionLayers& l, int x, int y, size_t i) {
  if (region == Region::all) return true;
  if (!(std::round(l.id[i]) > 0)) return false;
  if (region == Region::hit) return true;
  const DirectRange direct = direct_range(l.direct, x, y);
  if (!smooth_geometry(l, x, y, i) || shadow_edge(l, x, y, i, direct)) return false;
  if (region == Region::shadow) return direct.high == 0;
  if (region == Region::lit) return direct.low > 0;
  if (region == Region::shade) return l.lit.empty() ? direct.high == 0 : std::round(l.lit[i]) == 0;
  return true;
}

}  // namespace

std::string_view name(Region region) { return kNames[static_cast<size_t>(region)]; }

std::optional<Region> region_from_name(std::string_view name) {
  const auto found = std::find(kNames.begin(), kNames.end(), name);
  if (found == kNames.end()) return std::nullopt;
  return static_cast<Region>(found - kNames.begin());
}

Mask region_mask(Region region, const RegionLayers& layers) {
  const int width = layers.direct.width, height = layers.direct.height;
  Mask mask(layers.direct.pixels.size());
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const size_t i = static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x);
      mask[i] = in_region(region, layers, x, y, i);
    }
  return mask;
}

}  // namespace volgi
