// Regions of compare.py, line for line.
#include <algorithm>
#include <cmath>

#include "reference/metrics.h"

namespace volgi {
namespace {

constexpr std::array<std::string_view, 5> kNames{"all", "hit", "noedge", "shadow", "lit"};

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

double channel_sum(glm::vec3 c) { return static_cast<double>(c.x + c.y + c.z); }  // single precision, as numpy's

}  // namespace

std::string_view name(Region region) { return kNames[static_cast<size_t>(region)]; }

std::optional<Region> region_from_name(std::string_view name) {
  const auto found = std::find(kNames.begin(), kNames.end(), name);
  if (found == kNames.end()) return std::nullopt;
  return static_cast<Region>(found - kNames.begin());
}

Mask region_mask(Region region, const RegionLayers& layers) {
  const int width = layers.direct.width, height = layers.direct.height;
  Mask mask(layers.direct.pixels.size(), 1);
  if (region == Region::all) return mask;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const size_t i = static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x);
      mask[i] = std::round(layers.id[i]) > 0;
      if (region == Region::hit || mask[i] == 0) continue;
      double low = channel_sum(layers.direct.pixels[i]), high = low;
      for_neighbours(x, y, width, height, [&](size_t q) {
        const double sum = channel_sum(layers.direct.pixels[q]);
        low = std::min(low, sum);
        high = std::max(high, sum);
      });
      const bool shadow_edge = high - low > 0.35 * std::max(high, 1e-12);
      mask[i] = smooth_geometry(layers, x, y, i) && !shadow_edge;
      if (region == Region::shadow) mask[i] = mask[i] != 0 && high == 0;
      if (region == Region::lit) mask[i] = mask[i] != 0 && low > 0;
    }
  return mask;
}

}  // namespace volgi
