#include "core/emitter_points.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

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

/// Emitted radiance of a textured opaque triangle at its barycentrics: what surface_point() says, and no more.
class EmissionOfTexture {
 public:
  EmissionOfTexture(const Scene& scene, const Mesh& mesh, std::uint32_t triangle)
      : scene_(scene), material_(scene.materials[size_t(mesh.material)]) {
    const auto& uv = mesh.uv[size_t(material_.emissive.texcoord)];
    if (uv.empty()) return;
    const glm::uvec3 t = mesh.triangles[triangle];
    for (int k = 0; k < 3; ++k) corner_[k] = glm::vec2(material_.emissive.uv_from_texcoord * glm::vec3(uv[t[k]], 1.0f));
  }
  glm::dvec3 at(double u, double v) const {
    const glm::vec2 place = float(1.0 - u - v) * corner_[0] + float(u) * corner_[1] + float(v) * corner_[2];
    const glm::vec3 texel(sample_texture(scene_, material_.emissive.texture, place, true));
    return glm::dvec3(material_.emissive_radiance * texel);
  }

 private:
  const Scene& scene_;
  const Material& material_;
  glm::vec2 corner_[3] = {};
};

/// Mean of f over a triangle: at the centres of n² equal ones.
template <typename F>
glm::dvec3 mean_of(int n, const F& f) {
  glm::dvec3 sum(0.0);
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i + j < n; ++i) {
      sum += f((i + 1.0 / 3.0) / n, (j + 1.0 / 3.0) / n);
      if (i + j + 1 < n) sum += f((i + 2.0 / 3.0) / n, (j + 2.0 / 3.0) / n);
    }
  }
  return sum / double(n * n);
}

/// Mean of emitted radiance times alpha.
glm::dvec3 mean_emission(const Scene& scene, const Mesh& mesh, std::uint32_t triangle) {
  const Material& material = scene.materials[size_t(mesh.material)];
  const int n = lattice_of(scene, mesh, triangle);
  if (material.emissive.texture >= 0 && material.alpha_mode == AlphaMode::opaque && !material.unlit) {
    const EmissionOfTexture emission(scene, mesh, triangle);
    return mean_of(n, [&](double u, double v) { return emission.at(u, v); });
  }
  return mean_of(n, [&](double u, double v) {
    const SurfacePoint p = surface_point(scene, mesh, triangle, float(u), float(v));
    return glm::dvec3(p.emission) * double(p.alpha);
  });
}

std::vector<glm::dvec3> mean_emissions(const Scene& scene, const Mesh& mesh) {
  std::vector<glm::dvec3> means(mesh.triangles.size());
  tbb::parallel_for(tbb::blocked_range<size_t>(0, means.size(), 64), [&](const tbb::blocked_range<size_t>& range) {
    for (size_t t = range.begin(); t < range.end(); ++t) means[t] = mean_emission(scene, mesh, std::uint32_t(t));
  });
  return means;
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
    const std::vector<glm::dvec3> means = mean_emissions(scene, mesh);
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      const double area = area_of(mesh, t);
      const glm::dvec3 emission = means[t];
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
