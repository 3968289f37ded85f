#include "core/occluder_points.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>

#include "core/halton.h"
#include "core/surface.h"

namespace volgi {
namespace {

double area_of(const Mesh& mesh, glm::uvec3 c) {
  const glm::dvec3 a(mesh.positions[c.x]);
  return 0.5 * glm::length(glm::cross(glm::dvec3(mesh.positions[c.y]) - a, glm::dvec3(mesh.positions[c.z]) - a));
}

double area_of(const Scene& scene) {
  double sum = 0.0;
  for (const Mesh& mesh : scene.meshes) {
    for (const glm::uvec3 t : mesh.triangles) sum += area_of(mesh, t);
  }
  return sum;
}

/// The bits of `i` below `count`, a power of two, the other way round.
std::uint32_t reversed(std::uint32_t i, std::uint32_t count) {
  std::uint32_t out = 0;
  for (std::uint32_t bit = 1; bit < count; bit <<= 1) out = out << 1 | ((i & bit) != 0 ? 1u : 0u);
  return out;
}

}  // namespace

OccluderPoints::OccluderPoints(const Scene& scene, int count) : count_(count) {
  assert(count >= 1 && std::has_single_bit(unsigned(count)));
  choose(scene);
  place(scene);
}

void OccluderPoints::follow(const Scene& scene) {
  if (scene.triangle_count() != triangles_) choose(scene);
  place(scene);
}

void OccluderPoints::choose(const Scene& scene) {
  places_.assign(size_t(count_), Place());
  triangles_ = scene.triangle_count();
  const double whole_m2 = area_of(scene);
  each_m2_ = whole_m2 / count_;
  if (!(whole_m2 > 0.0)) return;
  double before_m2 = 0.0;
  std::uint32_t stratum = 0;
  for (std::uint32_t m = 0; m < scene.meshes.size(); ++m) {
    const Mesh& mesh = scene.meshes[m];
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      before_m2 += area_of(mesh, mesh.triangles[t]);
      // The middles of strata that lie in this triangle; the last takes what rounding leaves.
      while (stratum < std::uint32_t(count_) && (double(stratum) + 0.5) * each_m2_ < before_m2) {
        // No base 2: of a run, which takes every 2^n-th stratum, its digits would be alike.
        const double root = std::sqrt(radical_inverse(3, stratum + 1));
        const auto u = float(1.0 - root), v = float(root * radical_inverse(5, stratum + 1));
        const SurfacePoint p = surface_point(scene, mesh, t, u, v);
        const bool stops = radical_inverse(7, stratum + 1) < double(p.alpha);
        places_[reversed(stratum, std::uint32_t(count_))] = {m, t, u, v, stops};
        ++stratum;
      }
    }
  }
}

void OccluderPoints::place(const Scene& scene) {
  points_.assign(size_t(count_), shared::OccluderPoint{});
  for (size_t i = 0; i < places_.size(); ++i) {
    const Place& at = places_[i];
    if (!at.stops) continue;
    const Mesh& mesh = scene.meshes[at.mesh];
    const glm::uvec3 c = mesh.triangles[at.triangle];
    const glm::vec3 a = mesh.positions[c.x], b = mesh.positions[c.y] - a, d = mesh.positions[c.z] - a;
    const glm::vec3 across = glm::cross(b, d);
    const float length = glm::length(across);
    if (!(length > 0.0f)) continue;
    points_[i] = {a + at.u * b + at.v * d, float(each_m2_), across / length, 0.0f};
  }
}

}  // namespace volgi
