#include "reference/emitters.h"

#include <algorithm>
#include <cmath>

#include "core/luminance.h"
#include "core/surface.h"

namespace volgi {
namespace {

constexpr size_t kFew = 64;

double triangle_area(const Mesh& mesh, std::uint32_t triangle) {
  const glm::uvec3 t = mesh.triangles[triangle];
  const glm::dvec3 a(mesh.positions[t.x]);
  return 0.5 * glm::length(glm::cross(glm::dvec3(mesh.positions[t.y]) - a, glm::dvec3(mesh.positions[t.z]) - a));
}

// Weight of a triangle in the choice: mean luminance from a few points of a texture. Any positive weight is unbiased; a
// thousandth of the factor's luminance is kept where the points happen to miss the bright part.
double mean_luminance(const Scene& scene, const Mesh& mesh, std::uint32_t triangle) {
  const Material& material = scene.materials[static_cast<size_t>(mesh.material)];
  const double factor = luminance(material.emissive_radiance);
  if (material.emissive.texture < 0) return factor;
  constexpr int n = 8;
  double sum = 0;
  int count = 0;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n - j; ++i, ++count) {
      const float u = (static_cast<float>(i) + 1.0f / 3.0f) / n, v = (static_cast<float>(j) + 1.0f / 3.0f) / n;
      sum += luminance(surface_point(scene, mesh, triangle, u, v).emission);
    }
  return std::max(sum / count, 1e-3 * factor);
}

}  // namespace

Emitters::Emitters(const Scene& scene) : scene_(&scene), pdf_area_(scene.meshes.size()) {
  double total = 0;
  std::vector<double> areas;
  for (std::uint32_t m = 0; m < scene.meshes.size(); ++m) {
    const Mesh& mesh = scene.meshes[m];
    const Material& material = scene.materials[static_cast<size_t>(mesh.material)];
    if (!material.is_emissive()) continue;
    pdf_area_[m].assign(mesh.triangles.size(), 0.0f);
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      const double area = triangle_area(mesh, t);
      const double power = area * mean_luminance(scene, mesh, t) * (material.double_sided ? 2 : 1);
      if (!(power > 0)) continue;
      total += power;
      triangles_.push_back({{m, t}, 0.0f});
      areas.push_back(area);
      cumulative_.push_back(total);
    }
  }
  double before = 0;
  for (size_t i = 0; i < triangles_.size(); ++i) {
    Entry& entry = triangles_[i];
    const double probability = (cumulative_[i] - before) / total;
    before = cumulative_[i];
    cumulative_[i] /= total;
    entry.pdf_area = static_cast<float>(probability / areas[i]);
    pdf_area_[entry.index.mesh][entry.index.triangle] = entry.pdf_area;
  }
}

float Emitters::pdf_area(TriangleIndex index) const {
  const std::vector<float>& of_mesh = pdf_area_[index.mesh];
  return of_mesh.empty() ? 0.0f : of_mesh[index.triangle];
}

EmitterSample Emitters::sample(glm::vec2 uv, float choice) const {
  if (empty()) return {};
  const bool few = triangles_.size() <= kFew;
  const double xi = few ? uv.x : choice;
  const auto found = std::upper_bound(cumulative_.begin(), cumulative_.end(), xi);
  const size_t i = std::min(static_cast<size_t>(found - cumulative_.begin()), triangles_.size() - 1);
  const double below = i > 0 ? cumulative_[i - 1] : 0.0;
  if (few) uv.x = static_cast<float>(std::clamp((xi - below) / (cumulative_[i] - below), 0.0, 1.0));
  const Mesh& mesh = scene_->meshes[triangles_[i].index.mesh];
  const float root = std::sqrt(uv.x);  // uniform by area
  const SurfacePoint p = surface_point(*scene_, mesh, triangles_[i].index.triangle, 1.0f - root, uv.y * root);
  return {triangles_[i].index,
          p.position,
          p.geometric_normal,
          p.emission * p.alpha,
          scene_->materials[static_cast<size_t>(mesh.material)].double_sided,
          triangles_[i].pdf_area};
}

}  // namespace volgi
