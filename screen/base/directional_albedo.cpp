#include "screen/base/directional_albedo.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "core/halton.h"

namespace volgi::screen {
namespace {

constexpr int SAMPLES = 512;

/// Lambda of Smith's masking for GGX.
double hidden(double cosine, double alpha) {
  const double tangent2 = std::max(1.0 - cosine * cosine, 0.0) / (cosine * cosine);
  return 0.5 * (std::sqrt(1.0 + alpha * alpha * tangent2) - 1.0);
}

glm::vec2 reflected(double cosine, double roughness) {
  const double alpha = std::max(roughness * roughness, 1e-3), pi = glm::pi<double>();
  const glm::dvec3 viewer(std::sqrt(1.0 - cosine * cosine), 0.0, cosine);
  const glm::dvec3 stretched = glm::normalize(glm::dvec3(alpha * viewer.x, 0.0, viewer.z));
  const glm::dvec3 across(0.0, 1.0, 0.0), along = glm::cross(stretched, across);
  const double of_viewer = hidden(cosine, alpha), bend = 0.5 * (1.0 + stretched.z);
  glm::dvec2 sum(0.0);
  for (int i = 1; i <= SAMPLES; ++i) {
    const glm::dvec2 xi = halton(std::uint64_t(i));
    const double r = std::sqrt(xi.x), x = r * std::cos(2.0 * pi * xi.y);
    const double y = (1.0 - bend) * std::sqrt(1.0 - x * x) + bend * r * std::sin(2.0 * pi * xi.y);
    const glm::dvec3 h = x * across + y * along + std::sqrt(std::max(1.0 - x * x - y * y, 0.0)) * stretched;
    const glm::dvec3 facet = glm::normalize(glm::dvec3(alpha * h.x, alpha * h.y, std::max(h.z, 1e-9)));
    const double facing = glm::dot(viewer, facet);
    const double cos_light = 2.0 * facing * facet.z - viewer.z;
    if (cos_light <= 0.0) continue;
    const double both = (1.0 + of_viewer) / (1.0 + of_viewer + hidden(cos_light, alpha));
    const double grazing = std::pow(1.0 - std::clamp(facing, 0.0, 1.0), 5.0);
    sum += both * glm::dvec2(1.0 - grazing, grazing);
  }
  return glm::vec2(sum / double(SAMPLES));
}

}  // namespace

const std::vector<glm::vec2>& directional_albedo() {
  static const std::vector<glm::vec2> table = [] {
    std::vector<glm::vec2> values;
    for (int row = 0; row < DIRECTIONAL_ALBEDO_SIZE; ++row) {
      for (int column = 0; column < DIRECTIONAL_ALBEDO_SIZE; ++column)
        values.push_back(reflected((column + 0.5) / DIRECTIONAL_ALBEDO_SIZE, (row + 0.5) / DIRECTIONAL_ALBEDO_SIZE));
    }
    return values;
  }();
  return table;
}

}  // namespace volgi::screen
