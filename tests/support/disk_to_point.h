#pragma once
#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>

namespace volgi::test {

/// Irradiance at `x` of normal `n` from a one-sided Lambertian disk, over its flux [m^-2]: rings and spokes of it,
/// those below the horizon as they come (a negative cosine).
inline double disk_to_point_summed(glm::dvec3 x, glm::dvec3 n, glm::dvec3 middle, glm::dvec3 normal, double area_m2,
                                   int rings = 400, int spokes = 400) {
  const glm::dvec3 u =
      glm::normalize(glm::cross(normal, std::abs(normal.x) < 0.7 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)));
  const glm::dvec3 v = glm::cross(normal, u);
  const double radius = std::sqrt(area_m2 / glm::pi<double>());
  double sum = 0.0;
  for (int i = 0; i < rings; ++i) {
    const double r = radius * std::sqrt((i + 0.5) / rings);
    for (int k = 0; k < spokes; ++k) {
      const double angle = 2.0 * glm::pi<double>() * (k + 0.5) / spokes;
      const glm::dvec3 w = middle + r * (std::cos(angle) * u + std::sin(angle) * v) - x;
      const double squared = glm::dot(w, w);
      sum += glm::dot(w, n) * -glm::dot(w, normal) / (glm::pi<double>() * squared * squared);
    }
  }
  return sum / (double(rings) * spokes);
}

/// The same in closed form, as tables have it (Howell, B-13 and B-14); nothing behind the disk, and nothing where its
/// middle is below the horizon.
inline double disk_to_point_exact(glm::dvec3 x, glm::dvec3 n, glm::dvec3 middle, glm::dvec3 normal, double area_m2) {
  const glm::dvec3 w = middle - x;
  const double h = -glm::dot(w, normal), r2 = area_m2 / glm::pi<double>();
  const double lift = std::min(h, glm::dot(w, n));
  if (!(lift > 0.0)) return 0.0;
  const double apart = std::clamp(1e6 * lift * lift / r2 - 1.0, 0.0, 1.0);  // 0: both lie in one plane
  const double a = std::sqrt(std::max(glm::dot(w, w) - h * h, 1e-18));
  const double z = h * h + a * a + r2, root = std::sqrt(z * z - 4.0 * a * a * r2);
  const double parallel = 0.5 * (1.0 - (h * h + a * a - r2) / root), upright = 0.5 * h / a * (z / root - 1.0);
  const double facing = -glm::dot(n, normal);
  return apart * std::max(facing * parallel + (glm::dot(w, n) - facing * h) / a * upright, 0.0) / area_m2;
}

}  // namespace volgi::test
