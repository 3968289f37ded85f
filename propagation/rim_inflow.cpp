#include "propagation/rim_inflow.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace volgi {
namespace {

size_t nearest(const OrdinateSet& set, glm::vec3 d) {
  size_t best = 0;
  float most = -1.0f;
  for (size_t i = 0; i < set.directions.size(); ++i) {
    const float cosine = glm::dot(set.directions[i], d);
    if (cosine > most) most = cosine, best = i;
  }
  return best;
}

}  // namespace

std::vector<glm::vec3> rim_inflow(const Sky& sky, const OrdinateSet& set) {
  const size_t n = set.directions.size();
  std::vector<glm::dvec3> sum(8 * n, glm::dvec3(0.0));
  std::vector<double> solid_angle(8 * n, 0.0);
  // Texels, but enough of them that every direction has many.
  const int height = std::max(sky.image().height, 128), width = 2 * height;
  const double scale_x = double(sky.image().width) / width, scale_y = double(sky.image().height) / height;
  for (int y = 0; y < height; ++y) {
    const double dw = std::cos(glm::pi<double>() * y / height) - std::cos(glm::pi<double>() * (y + 1) / height);
    for (int x = 0; x < width; ++x) {
      const glm::vec3 towards = sky.direction_at((x + 0.5) * scale_x, (y + 0.5) * scale_y), d = -towards;
      const size_t octant = size_t(d.x > 0.0f) | size_t(d.y > 0.0f) << 1 | size_t(d.z > 0.0f) << 2;
      const size_t at = octant * n + nearest(set, glm::abs(d));
      sum[at] += glm::dvec3(sky.radiance(towards)) * dw;
      solid_angle[at] += dw;
    }
  }
  std::vector<glm::vec3> flux(8 * n);
  for (size_t k = 0; k < flux.size(); ++k) flux[k] = glm::vec3(sum[k] / solid_angle[k] * double(set.weights[k % n]));
  return flux;
}

}  // namespace volgi
