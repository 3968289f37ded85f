#include "screen/base/directional_albedo.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "core/halton.h"
#include "shaders/shared/material.shared.h"

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

/// Of a lobe (n + 2) / 2 pi (R.l)^n.
glm::vec2 reflected_by_phong(double cosine, double roughness) {
  constexpr int EDGE = 64;
  const double n = double(shared::phong_exponent(float(roughness))), sine = std::sqrt(1.0 - cosine * cosine);
  double sum = 0.0;
  for (int i = 0; i < EDGE; ++i) {
    // By the lobe's own density, (n + 1) / 2 pi (R.l)^n.
    const double along = std::pow((i + 0.5) / EDGE, 1.0 / (n + 1.0)), aside = std::sqrt(1.0 - along * along);
    for (int k = 0; k < EDGE; ++k) {
      const double turn = glm::two_pi<double>() * (k + 0.5) / EDGE;
      sum += std::max(along * cosine + aside * std::cos(turn) * sine, 0.0);
    }
  }
  return {float((n + 2.0) / (n + 1.0) * sum / (EDGE * EDGE)), 0.0f};
}

std::vector<glm::vec2> table_of(glm::vec2 (*reflected)(double cosine, double roughness)) {
  std::vector<glm::vec2> values;
  for (int row = 0; row < DIRECTIONAL_ALBEDO_SIZE; ++row) {
    for (int column = 0; column < DIRECTIONAL_ALBEDO_SIZE; ++column)
      values.push_back(reflected((column + 0.5) / DIRECTIONAL_ALBEDO_SIZE, (row + 0.5) / DIRECTIONAL_ALBEDO_SIZE));
  }
  return values;
}

}  // namespace

const std::vector<glm::vec2>& directional_albedo(bool phong) {
  static const std::vector<glm::vec2> facets = table_of(reflected);
  if (!phong) return facets;
  static const std::vector<glm::vec2> lobes = table_of(reflected_by_phong);
  return lobes;
}

}  // namespace volgi::screen
