#include "core/visibility/light_flux.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cassert>

#include "core/light_layers.h"
#include "core/surface.h"

namespace volgi {

namespace {

struct Layer {
  shared::PunctualLight light;
  shared::ReflectiveShadowLayer view;
  int layer_count;
  int resolution;
  std::uint32_t first_texel;  // of this layer among all: what BLEND is hashed with
};

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

struct TexelRay {
  glm::vec3 origin, direction;
  glm::vec3 power;  // before the range window [W]
};

/// Mean of a spot's falloff over the texel, 4 x 4 points: a cone's edge is often thinner than a texel.
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

TexelRay ray_through(const Layer& layer, glm::ivec2 texel) {
  const glm::vec2 uv = (glm::vec2(texel) + place_in_texel(texel)) * (2.0f / float(layer.resolution)) - 1.0f;
  const shared::ReflectiveShadowLayer& view = layer.view;
  const glm::vec2 middle = (glm::vec2(texel) + 0.5f) * (2.0f / float(layer.resolution)) - 1.0f;
  const float measure = shared::rsm_texel_measure(view, layer.resolution, middle.x, middle.y);
  TexelRay ray{view.origin, view.forward, layer.light.intensity * measure};
  if (view.directional != 0) {
    ray.origin = shared::rsm_position_from_uvz(view, glm::vec3(uv, 0.0f));
    return ray;
  }
  ray.direction = glm::normalize(shared::rsm_position_from_uvz(view, glm::vec3(uv, 1.0f)) - view.origin);
  if (layer.light.type == LIGHT_SPOT) ray.power *= mean_falloff(layer, texel);
  return ray;
}

/// What the light sees through one texel; no flux: nothing, or another layer counts it.
FluxSample texel_flux(const EmbreeScene& embree, const Layer& layer, glm::ivec2 texel) {
  FluxSample none{};
  if (!shared::rsm_texel_counts(layer.layer_count, layer.resolution, texel.x, texel.y)) return none;
  const TexelRay ray = ray_through(layer, texel);
  if (ray.power == glm::vec3(0.0f)) return none;
  const std::uint32_t seed = layer.first_texel + std::uint32_t(texel.y * layer.resolution + texel.x);
  RayHit hit;
  if (!embree.intersect(ray.origin, ray.direction, std::numeric_limits<float>::infinity(), seed, hit)) return none;
  const Scene& scene = embree.scene();
  const SurfacePoint at = surface_point(scene, scene.meshes[hit.mesh], hit.triangle, hit.u, hit.v);
  const float window = layer.view.directional != 0 ? 1.0f : shared::range_window(layer.light, hit.distance);
  const bool front = glm::dot(at.geometric_normal, ray.direction) < 0.0f;
  return {at.position, front ? at.geometric_normal : -at.geometric_normal, ray.power * window * at.albedo * hit.tint};
}

/// One row of texels of a layer.
std::vector<FluxSample> row_flux(const EmbreeScene& embree, const Layer& layer, int row) {
  std::vector<FluxSample> samples;
  for (int x = 0; x < layer.resolution; ++x) {
    const FluxSample sample = texel_flux(embree, layer, {x, row});
    if (sample.flux != glm::vec3(0.0f)) samples.push_back(sample);
  }
  return samples;
}

/// By row of all layers; rows first, first + step, ... alone.
std::vector<std::vector<FluxSample>> rows_flux(const EmbreeScene& embree, int texels_on_edge, size_t first,
                                               size_t step) {
  assert(texels_on_edge >= 16);
  struct Row {
    const Layer* layer;
    int row;
  };
  const std::vector<Layer> layers = layers_of(embree.scene(), texels_on_edge);
  std::vector<Row> rows;
  for (const Layer& layer : layers) {
    for (int row = 0; row < layer.resolution; ++row) rows.push_back({&layer, row});
  }
  std::vector<std::vector<FluxSample>> found(rows.size());
  oneapi::tbb::parallel_for(first, rows.size(), step,
                            [&](size_t i) { found[i] = row_flux(embree, *rows[i].layer, rows[i].row); });
  return found;
}

}  // namespace

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
