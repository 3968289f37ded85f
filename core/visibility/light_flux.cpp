#include "core/visibility/light_flux.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cassert>

#include "core/light_layers.h"
#include "core/surface.h"

namespace volgi {

struct LightRays::Layer {
  shared::PunctualLight light;
  shared::ReflectiveShadowLayer view;
  int layer_count;
  int resolution;
  std::uint32_t first_texel;  // of this layer among all: what BLEND is hashed with
};

namespace {

template <class Layer>
std::vector<Layer> layers_of(const Scene& scene, int texels_on_edge) {
  std::vector<Layer> layers;
  std::uint32_t texels = 0;
  for (const Light& light : scene.lights) {
    int resolution = light.type == Light::Type::directional ? 2 * texels_on_edge : texels_on_edge;
    auto views = reflective_shadow_layers(light, resolution, scene.bounds_min, scene.bounds_max);
    if (views.size() > 1) {
      resolution = texels_on_edge / 2;
      views = reflective_shadow_layers(light, resolution, scene.bounds_min, scene.bounds_max);
    }
    for (const shared::ReflectiveShadowLayer& view : views) {
      layers.push_back({to_shared(light), view, int(views.size()), resolution, texels});
      texels += std::uint32_t(resolution) * std::uint32_t(resolution);
    }
  }
  return layers;
}

/// Mean of a spot's falloff over the texel, 4 x 4 points: a cone's edge is often thinner than a texel.
template <class Layer>
float mean_falloff(const Layer& layer, glm::ivec2 texel) {
  constexpr int kPoints = 4;
  float sum = 0.0f;
  for (int i = 0; i < kPoints * kPoints; ++i) {
    const glm::vec2 in_texel = (glm::vec2(i % kPoints, i / kPoints) + 0.5f) / float(kPoints);
    const glm::vec2 uv = (glm::vec2(texel) + in_texel) * (2.0f / float(layer.resolution)) - 1.0f;
    const glm::vec3 to = shared::rsm_position_from_uvz(layer.view, glm::vec3(uv, 1.0f)) - layer.view.origin;
    sum += shared::spot_falloff(layer.light, glm::normalize(to));
  }
  return sum / float(kPoints * kPoints);
}

/// Where in its texel a ray goes: not the middle, so that edges of objects along rows of texels are not met or missed
/// by a whole row at once (0.3 % of the light of cornell at 256 texels). An additive recurrence (Roberts 2018: powers
/// of 1/1.3247..., the plastic number), even over any block of texels.
glm::vec2 place_in_texel(glm::ivec2 texel) {
  const double n = double(texel.x) + 5741.0 * double(texel.y);  // rows far apart in the sequence
  return {float(glm::fract(0.7548776662466927 * n)), float(glm::fract(0.5698402909980532 * n))};
}

template <class Layer>
LightRay ray_through(const Layer& layer, glm::ivec2 texel) {
  const glm::vec2 uv = (glm::vec2(texel) + place_in_texel(texel)) * (2.0f / float(layer.resolution)) - 1.0f;
  const shared::ReflectiveShadowLayer& view = layer.view;
  const glm::vec2 middle = (glm::vec2(texel) + 0.5f) * (2.0f / float(layer.resolution)) - 1.0f;
  const float measure = shared::rsm_texel_measure(view, layer.resolution, middle.x, middle.y);
  const std::uint32_t seed = layer.first_texel + std::uint32_t(texel.y * layer.resolution + texel.x);
  LightRay ray{view.origin, view.forward, layer.light.intensity * measure, seed, layer.light, view.directional != 0};
  if (ray.from_afar) {
    ray.origin = shared::rsm_position_from_uvz(view, glm::vec3(uv, 0.0f));
    return ray;
  }
  ray.direction = glm::normalize(shared::rsm_position_from_uvz(view, glm::vec3(uv, 1.0f)) - view.origin);
  if (layer.light.type == LIGHT_SPOT) ray.power *= mean_falloff(layer, texel);
  return ray;
}

/// What the light sees along a ray; no flux: nothing.
FluxSample ray_flux(const EmbreeScene& embree, const LightRay& ray) {
  RayHit hit;
  if (!embree.intersect(ray.origin, ray.direction, std::numeric_limits<float>::infinity(), ray.seed, hit)) return {};
  const Scene& scene = embree.scene();
  const SurfacePoint at = surface_point(scene, scene.meshes[hit.mesh], hit.triangle, hit.u, hit.v);
  const bool front = glm::dot(at.geometric_normal, ray.direction) < 0.0f;
  return {at.position, front ? at.geometric_normal : -at.geometric_normal,
          ray.power_after(hit.distance) * at.albedo * hit.tint};
}

/// By row of all layers; rows first, first + step, ... alone.
std::vector<std::vector<FluxSample>> rows_flux(const EmbreeScene& embree, int texels_on_edge, size_t first,
                                               size_t step) {
  const LightRays rays(embree.scene(), texels_on_edge);
  std::vector<std::vector<FluxSample>> found(rays.rows());
  oneapi::tbb::parallel_for(first, found.size(), step, [&](size_t row) {
    rays.for_each_of_row(row, [&](const LightRay& ray) {
      const FluxSample sample = ray_flux(embree, ray);
      if (sample.flux != glm::vec3(0.0f)) found[row].push_back(sample);
    });
  });
  return found;
}

}  // namespace

glm::vec3 LightRay::power_after(float distance) const {
  return power * (from_afar ? 1.0f : shared::range_window(light, distance));
}

LightRays::LightRays(const Scene& scene, int texels_on_edge) : layers_(layers_of<Layer>(scene, texels_on_edge)) {
  assert(texels_on_edge >= 16);
  for (size_t i = 0; i < layers_.size(); ++i) {
    for (int row = 0; row < layers_[i].resolution; ++row) rows_.push_back({i, row});
  }
}

LightRays::~LightRays() = default;

/// Texels that another layer counts are left out.
void LightRays::for_each_of_row(size_t row, const std::function<void(const LightRay&)>& take) const {
  const Layer& layer = layers_[rows_[row].layer];
  for (int x = 0; x < layer.resolution; ++x) {
    const glm::ivec2 texel(x, rows_[row].row);
    if (!shared::rsm_texel_counts(layer.layer_count, layer.resolution, texel.x, texel.y)) continue;
    const LightRay ray = ray_through(layer, texel);
    if (ray.power != glm::vec3(0.0f)) take(ray);
  }
}

std::vector<FluxSample> light_flux(const EmbreeScene& embree, int texels_on_edge) {
  std::vector<FluxSample> samples;
  for (const std::vector<FluxSample>& row : rows_flux(embree, texels_on_edge, 0, 1))
    samples.insert(samples.end(), row.begin(), row.end());
  return samples;
}

std::vector<NumberedFluxSample> light_flux(const EmbreeScene& embree, int texels_on_edge, int rank, int ranks) {
  std::vector<NumberedFluxSample> samples;
  const auto rows = rows_flux(embree, texels_on_edge, size_t(rank), size_t(ranks));
  for (std::uint64_t row = 0; row < rows.size(); ++row) {
    for (std::uint64_t i = 0; i < rows[row].size(); ++i) samples.push_back({rows[row][i], row << 32 | i});
  }
  return samples;
}

}  // namespace volgi
