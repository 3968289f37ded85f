#include "core/exposure.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/luminance.h"

namespace volgi {

float automatic_exposure_ev(const Image& image) {
  std::vector<double> stops;
  stops.reserve(image.pixels.size());
  for (const glm::vec3& p : image.pixels) {
    const double y = luminance(glm::dvec3(p));
    if (std::isfinite(y) && y > 0.0) stops.push_back(std::log2(y));
  }
  if (stops.empty()) return 0.0f;
  std::sort(stops.begin(), stops.end());
  const size_t cut = stops.size() / 20;
  double sum = 0.0;
  for (size_t i = cut; i < stops.size() - cut; ++i) sum += stops[i];
  const double mean = sum / double(stops.size() - 2 * cut);
  return float(std::round(100.0 * (std::log2(0.18) - mean)) / 100.0);
}

}  // namespace volgi
