#include "core/emitter_points.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <numeric>
#include <utility>

#include "core/halton.h"
#include "core/hilbert.h"
#include "core/luminance.h"
#include "core/sample_sequence.h"
#include "core/surface.h"

namespace volgi {
namespace {

double area_of(const Mesh& mesh, std::uint32_t triangle) {
  const glm::uvec3 t = mesh.triangles[triangle];
  const glm::dvec3 a(mesh.positions[t.x]);
  return 0.5 * glm::length(glm::cross(glm::dvec3(mesh.positions[t.y]) - a, glm::dvec3(mesh.positions[t.z]) - a));
}

/// Texels along the longest edge of the triangle in a texture.
double texels_along(const Scene& scene, const Mesh& mesh, std::uint32_t triangle, const TextureUse& use) {
  const auto& uv = mesh.uv[size_t(use.texcoord)];
  if (use.texture < 0 || uv.empty()) return 0.0;
  const TextureImage& image = scene.images[size_t(scene.textures[size_t(use.texture)].image)];
  const glm::uvec3 t = mesh.triangles[triangle];
  double longest = 0.0;
  for (int k = 0; k < 3; ++k) {
    const glm::vec2 edge = glm::mat2(use.uv_from_texcoord) * (uv[t[(k + 1) % 3]] - uv[t[k]]);
    longest = std::max(longest, double(glm::length(edge * glm::vec2(image.width, image.height))));
  }
  return longest;
}

/// Points on an edge of the lattice that measures a triangle's mean emission; 1 where it is the same everywhere.
int lattice_of(const Scene& scene, const Mesh& mesh, std::uint32_t triangle) {
  const Material& material = scene.materials[size_t(mesh.material)];
  const bool covered = material.alpha_mode == AlphaMode::opaque;
  if (material.emissive.texture < 0 && (covered || (material.base_color.texture < 0 && mesh.colors.empty()))) return 1;
  double texels = texels_along(scene, mesh, triangle, material.emissive);
  if (!covered) texels = std::max(texels, texels_along(scene, mesh, triangle, material.base_color));
  return int(std::clamp(std::ceil(2.0 * texels), 4.0, 128.0));
}

/// Mean of emitted radiance times alpha: the centres of n² equal triangles.
glm::dvec3 mean_emission(const Scene& scene, const Mesh& mesh, std::uint32_t triangle) {
  const int n = lattice_of(scene, mesh, triangle);
  glm::dvec3 sum(0.0);
  const auto add = [&](double u, double v) {
    const SurfacePoint p = surface_point(scene, mesh, triangle, float(u / n), float(v / n));
    sum += glm::dvec3(p.emission) * double(p.alpha);
  };
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i + j < n; ++i) {
      add(i + 1.0 / 3.0, j + 1.0 / 3.0);
      if (i + j + 1 < n) add(i + 2.0 / 3.0, j + 2.0 / 3.0);
    }
  }
  return sum / double(n * n);
}

std::vector<EmitterPoint> in_order_of(const std::vector<std::uint64_t>& places,
                                      const std::vector<EmitterPoint>& points) {
  std::vector<size_t> order(points.size());
  std::iota(order.begin(), order.end(), size_t(0));
  std::sort(order.begin(), order.end(),
            [&](size_t a, size_t b) { return std::pair(places[a], a) < std::pair(places[b], b); });
  std::vector<EmitterPoint> ordered;
  ordered.reserve(points.size());
  for (const size_t i : order) ordered.push_back(points[i]);
  return ordered;
}

}  // namespace

EmitterPoints::EmitterPoints(const Scene& scene) : scene_(&scene) {
  double total = 0.0;
  for (std::uint32_t m = 0; m < scene.meshes.size(); ++m) {
    const Mesh& mesh = scene.meshes[m];
    const Material& material = scene.materials[size_t(mesh.material)];
    if (!material.is_emissive()) continue;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      const double area = area_of(mesh, t);
      const glm::dvec3 emission = mean_emission(scene, mesh, t);
      // Bright spots that the lattice missed still get a point now and then.
      const double weight = std::max(luminance(emission), 1e-3 * luminance(material.emissive_radiance)) * area;
      if (!(weight > 0.0)) continue;
      for (int side = 0; side < (material.double_sided ? 2 : 1); ++side) {
        flux_ += glm::pi<double>() * area * emission;
        total += weight;
        sides_.push_back({m, t, side == 1, area});
        cumulative_.push_back(total);
      }
    }
  }
  for (double& c : cumulative_) c /= total;
}

std::vector<EmitterPoint> EmitterPoints::points(int count, int sample) const {
  std::vector<EmitterPoint> points;
  if (empty()) return points;
  points.reserve(size_t(count));
  std::vector<std::uint64_t> places;  // side, then place on the curve
  places.reserve(size_t(count));
  const double in_stratum = place_in_strata(std::uint64_t(sample));
  const std::uint64_t first = first_halton_point(std::uint64_t(sample), count);
  size_t side = 0;
  for (int i = 0; i < count; ++i) {
    while (side + 1 < sides_.size() && cumulative_[side] <= (i + in_stratum) / count) ++side;
    const Side& s = sides_[side];
    const double probability = cumulative_[side] - (side > 0 ? cumulative_[side - 1] : 0.0);
    const double area = s.area_m2 / (probability * count);
    const glm::dvec2 xi = halton(first + std::uint64_t(i));
    const double root = std::sqrt(xi.x);  // even by area
    const Mesh& mesh = scene_->meshes[s.mesh];
    const SurfacePoint p = surface_point(*scene_, mesh, s.triangle, float(1.0 - root), float(root * xi.y));
    const glm::vec3 radiance = p.emission * p.alpha;
    points.push_back({p.position, s.back ? -p.geometric_normal : p.geometric_normal,
                      glm::vec3(glm::dvec3(radiance) * (glm::pi<double>() * area)), float(area)});
    places.push_back(std::uint64_t(side) << 32 | hilbert_index(glm::vec2(xi)));
  }
  return in_order_of(places, points);
}

}  // namespace volgi
