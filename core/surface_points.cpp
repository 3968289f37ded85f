#include "core/surface_points.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/halton.h"
#include "core/sample_sequence.h"
#include "core/surface.h"

namespace volgi {
namespace {

struct Triangle {
  std::uint32_t mesh, triangle;
  double cumulative_m2;  // of the scene's triangles up to this one
};

std::vector<Triangle> triangles_by_area(const Scene& scene) {
  std::vector<Triangle> all;
  double total = 0.0;
  for (std::uint32_t m = 0; m < scene.meshes.size(); ++m) {
    const Mesh& mesh = scene.meshes[m];
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      const glm::uvec3 c = mesh.triangles[t];
      const glm::dvec3 a(mesh.positions[c.x]);
      const double area =
          0.5 * glm::length(glm::cross(glm::dvec3(mesh.positions[c.y]) - a, glm::dvec3(mesh.positions[c.z]) - a));
      if (area > 0.0) all.push_back({m, t, total += area});
    }
  }
  return all;
}

std::uint64_t spread_bits(std::uint64_t x) {  // 16 bits, two zeros between
  x = (x | x << 16) & 0x00ff0000ff0000ffull;
  x = (x | x << 8) & 0xf00f00f00f00f00full;
  x = (x | x << 4) & 0x30c30c30c30c30c3ull;
  return (x | x << 2) & 0x9249249249249249ull;
}

/// The normal's axis and sign, then Morton's curve over the bounds.
std::uint64_t place_of(const Scene& scene, const SurfaceSample& p) {
  const glm::vec3 a = glm::abs(p.normal);
  const int axis = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
  const std::uint64_t facing = 2 * std::uint64_t(axis) + (p.normal[axis] < 0.0f ? 1 : 0);
  const glm::vec3 size = glm::max(scene.bounds_max - scene.bounds_min, glm::vec3(1e-20f));
  const glm::vec3 at = glm::clamp((p.position - scene.bounds_min) / size, 0.0f, 1.0f) * 65535.0f;
  return facing << 48 | spread_bits(std::uint64_t(at.x)) | spread_bits(std::uint64_t(at.y)) << 1 |
         spread_bits(std::uint64_t(at.z)) << 2;
}

}  // namespace

std::vector<SurfaceSample> surface_points(const Scene& scene, int count, int sample) {
  const std::vector<Triangle> triangles = triangles_by_area(scene);
  std::vector<SurfaceSample> points;
  if (triangles.empty() || count < 1) return points;
  const double each_m2 = 2.0 * triangles.back().cumulative_m2 / count;  // both sides
  const double in_stratum = place_in_strata(std::uint64_t(sample));
  const std::uint64_t first = first_halton_point(std::uint64_t(sample), count);
  size_t at = 0;
  for (int i = 0; i < count; ++i) {
    while (at + 1 < triangles.size() && triangles[at].cumulative_m2 <= (i + in_stratum) * each_m2 * 0.5) ++at;
    const Mesh& mesh = scene.meshes[triangles[at].mesh];
    const glm::dvec2 xi = halton(first + std::uint64_t(i));
    const double root = std::sqrt(xi.x);  // even by area
    const SurfacePoint p = surface_point(scene, mesh, triangles[at].triangle, float(1.0 - root), float(root * xi.y));
    // Sides by the next digit of another sequence, so that both get their half in every neighbourhood.
    const bool back = radical_inverse(5, first + std::uint64_t(i)) >= 0.5;
    points.push_back({p.position, back ? -p.geometric_normal : p.geometric_normal, p.albedo * p.alpha, float(each_m2)});
  }
  std::vector<std::pair<std::uint64_t, size_t>> order;
  order.reserve(points.size());
  for (size_t i = 0; i < points.size(); ++i) order.emplace_back(place_of(scene, points[i]), i);
  std::sort(order.begin(), order.end());
  std::vector<SurfaceSample> ordered;
  ordered.reserve(points.size());
  for (const auto& [place, i] : order) ordered.push_back(points[i]);
  return ordered;
}

}  // namespace volgi
