#include "core/light_shares.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <numeric>

#include "core/light_layers.h"
#include "core/luminance.h"
#include "core/sky.h"

namespace volgi {
namespace {

/// A room whose lamp is weak beside another room's is all the same lit by it alone: the least share of a source is this
/// part of an even one. The strong lose no more than an eighth of theirs.
constexpr size_t EVEN_OVER_LEAST = 8;

/// 1 - cos without the cancellation.
double one_minus_cos(double angle_rad) {
  const double s = std::sin(0.5 * angle_rad);
  return 2.0 * s * s;
}

/// Integral of glTF's spot falloff over the sphere [sr]: ((c - cos outer) s)² from the outer cone until it reaches 1 at
/// the inner one, 1 from there to the axis. Its slope s is at most 1000, so that a narrow cone may end before.
double spot_solid_angle(const Light& light) {
  const double outer = one_minus_cos(double(light.outer_cone_rad));
  const double ramp = std::max(0.001, outer - one_minus_cos(double(light.inner_cone_rad)));
  const double reached = std::min(outer, ramp);
  return 2.0 * glm::pi<double>() * (reached * reached * reached / (3.0 * ramp * ramp) + (outer - reached));
}

/// What enters the scene's bounds: a convex body's mean shadow is a quarter of its surface.
double power_of_sky(const Scene& scene) {
  if (!scene.sky) return 0.0;
  const glm::dvec3 d = glm::dvec3(scene.bounds_max) - glm::dvec3(scene.bounds_min);
  return luminance(scene.sky->integral()) * 0.25 * 2.0 * (d.x * d.y + d.y * d.z + d.z * d.x);
}

/// Power of all sources, the sky and emissive surfaces last.
std::vector<double> power_of_sources(const Scene& scene, glm::dvec3 emitted_flux, bool with_sky) {
  std::vector<double> power;
  for (const Light& light : scene.lights) power.push_back(power_luminance(light, scene.bounds_min, scene.bounds_max));
  power.push_back(with_sky ? power_of_sky(scene) : 0.0);
  power.push_back(luminance(emitted_flux));
  return power;
}

/// Of a source by its place in power_of_sources().
bool from_outside(const Scene& scene, size_t i) {
  const size_t sky = scene.lights.size();
  return i == sky || (i < sky && scene.lights[i].type == Light::Type::directional);
}

struct Kinds {
  double outside = 0.0, within = 0.0;
};
Kinds kinds_of(const Scene& scene, const std::vector<double>& power) {
  Kinds sum;
  for (size_t i = 0; i < power.size(); ++i) (from_outside(scene, i) ? sum.outside : sum.within) += power[i];
  return sum;
}

/// What comes from outside has no more than what is within, where there is anything.
void bound_by_what_is_within(const Scene& scene, std::vector<double>& power) {
  const Kinds sum = kinds_of(scene, power);
  if (!(sum.within > 0.0) || sum.outside <= sum.within) return;
  for (size_t i = 0; i < power.size(); ++i)
    if (from_outside(scene, i)) power[i] *= sum.within / sum.outside;
}

/// As if emissive textures were white.
glm::dvec3 emitted_at_most(const Scene& scene) {
  glm::dvec3 flux(0.0);
  for (const Mesh& mesh : scene.meshes) {
    const Material& m = scene.materials[size_t(mesh.material)];
    if (!m.is_emissive()) continue;
    double area = 0.0;
    for (const glm::uvec3& t : mesh.triangles) {
      const glm::dvec3 a(mesh.positions[t.x]), b(mesh.positions[t.y]), c(mesh.positions[t.z]);
      area += 0.5 * glm::length(glm::cross(b - a, c - a));
    }
    flux += glm::pi<double>() * area * (m.double_sided ? 2.0 : 1.0) * glm::dvec3(m.emissive_radiance);
  }
  return flux;
}

LightShares from_counts(std::vector<int> counts) {
  const int of_emitters = counts.back();
  counts.pop_back();
  const int of_sky = counts.back();
  counts.pop_back();
  return {std::move(counts), of_sky, of_emitters};
}

}  // namespace

double rectangle_of_sun_m2(const shared::ReflectiveShadowLayer& layer, int resolution) {
  const double inner = 1.0 - 2.0 * RSM_MARGIN_TEXELS / double(resolution);
  return 4.0 * double(layer.extent_x) * double(layer.extent_y) * inner * inner;
}

double power_luminance(const Light& light, glm::vec3 bounds_min, glm::vec3 bounds_max) {
  const double intensity = luminance(light.intensity);
  switch (light.type) {
    case Light::Type::spot:
      return intensity * spot_solid_angle(light);
    case Light::Type::directional: {
      constexpr int any_resolution = 256;  // the margin that it makes is taken off again
      const auto layers = reflective_shadow_layers(light, any_resolution, bounds_min, bounds_max);
      return intensity * rectangle_of_sun_m2(layers.front(), any_resolution);
    }
    case Light::Type::point:
      break;
  }
  return intensity * 4.0 * glm::pi<double>();
}

std::vector<int> share_out(const std::vector<double>& power, int count) {
  std::vector<int> share(power.size(), 0);
  std::vector<size_t> sources;  // that take part
  for (size_t i = 0; i < power.size(); ++i) {
    if (power[i] > 0.0) sources.push_back(i);
  }
  std::stable_sort(sources.begin(), sources.end(), [&](size_t a, size_t b) { return power[a] > power[b]; });
  if (sources.empty()) return share;
  if (size_t(count) <= sources.size()) {
    for (size_t k = 0; k < size_t(count); ++k) share[sources[k]] = 1;
    return share;
  }
  // Sources too weak for the least share get it, the weakest first; the rest is for the others.
  const int least = std::max(1, count / int(EVEN_OVER_LEAST * sources.size()));
  double total = 0.0;
  for (const size_t i : sources) total += power[i];
  while (sources.size() > 1 && power[sources.back()] * count < least * total) {
    share[sources.back()] = least;
    total -= power[sources.back()];
    sources.pop_back();
    count -= least;
  }
  std::vector<double> remainder(power.size(), 0.0);
  int left = count;
  for (const size_t i : sources) {
    const double quota = power[i] / total * count;
    share[i] = std::max(1, int(quota));
    remainder[i] = quota - share[i];
    left -= share[i];
  }
  std::stable_sort(sources.begin(), sources.end(), [&](size_t a, size_t b) { return remainder[a] > remainder[b]; });
  for (size_t k = 0; left > 0; ++k, --left) ++share[sources[k % sources.size()]];
  return share;
}

LightShares share_by_power(const Scene& scene, glm::dvec3 emitted_flux, int count, bool with_sky) {
  std::vector<double> power = power_of_sources(scene, emitted_flux, with_sky);
  bound_by_what_is_within(scene, power);
  return from_counts(share_out(power, count));
}

double share_within(const Scene& scene) {
  const Kinds sum = kinds_of(scene, power_of_sources(scene, emitted_at_most(scene), true));
  const double less = std::min(sum.outside, sum.within), more = std::max(sum.outside, sum.within);
  return less > 0.0 ? less / more : 1.0;
}

LightShares share_equally(const Scene& scene, glm::dvec3 emitted_flux, int each, bool with_sky) {
  std::vector<int> counts;
  for (const double power : power_of_sources(scene, emitted_flux, with_sky)) counts.push_back(power > 0.0 ? each : 0);
  return from_counts(counts);
}

}  // namespace volgi
