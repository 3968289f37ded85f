#include "core/visibility/virtual_lights_cpu.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <limits>
#include <utility>

#include "core/halton.h"
#include "core/hilbert.h"
#include "core/light.h"
#include "core/light_cone.h"
#include "core/light_layers.h"
#include "core/light_shares.h"
#include "core/surface.h"

namespace volgi {

namespace {

using shared::VirtualLight;

constexpr float kMinCosine = 0.05f;  // docs/conventions.md#virtual-lights
constexpr int kAnyResolution = 256;  // of a sun's layer: the margin that it makes is taken off again

/// A part of what a punctual light sends.
struct LightRay {
  glm::vec3 origin, direction;
  glm::vec3 power;  // before the range window [W]
  float measure;    // solid angle [sr], of a sun area across the light [m^2]
  glm::vec2 place;  // among all of the light's, in [0, 1]^2
};

std::vector<LightRay> rays_of_sun(const Scene& scene, const Light& light, int count) {
  const auto layers = reflective_shadow_layers(light, kAnyResolution, scene.bounds_min, scene.bounds_max);
  const shared::ReflectiveShadowLayer& view = layers.front();
  const float inner = 1.0f - 2.0f * float(RSM_MARGIN_TEXELS) / float(kAnyResolution);
  const auto measure = float(rectangle_of_sun_m2(view, kAnyResolution) / count);
  std::vector<LightRay> rays;
  for (int i = 1; i <= count; ++i) {
    const glm::vec2 place(halton(std::uint64_t(i)));
    const glm::vec2 uv = (2.0f * place - 1.0f) * inner;
    const glm::vec3 origin = shared::rsm_position_from_uvz(view, glm::vec3(uv, 0.0f));
    rays.push_back({origin, view.forward, light.intensity * measure, measure, place});
  }
  return rays;
}

std::vector<LightRay> rays_of_cone(const Light& light, int count) {
  const shared::PunctualLight l = to_shared(light);
  const bool spot = light.type == Light::Type::spot;
  const glm::mat3 turn = spot ? world_from_axis(glm::dvec3(light.direction)) : glm::mat3(1.0f);
  const auto measure = float(2.0 * glm::pi<double>() * cone_height(light) / count);
  std::vector<LightRay> rays;
  for (const glm::vec3 sample : halton_directions_in_cone(cone_height(light), count)) {
    const glm::vec3 direction = glm::normalize(turn * sample);
    const float falloff = spot ? shared::spot_falloff(l, direction) : 1.0f;
    const glm::vec2 place(std::atan2(sample.z, sample.x) * glm::one_over_two_pi<float>() + 0.5f,
                          (sample.y + 1.0f) / float(cone_height(light)));
    rays.push_back({light.position, direction, light.intensity * (falloff * measure), measure, place});
  }
  return rays;
}

/// @param seed  of this ray alone: what BLEND is hashed with.
VirtualLight end_of(const EmbreeScene& embree, const LightRay& ray, int source, std::uint32_t seed) {
  const Scene& scene = embree.scene();
  const Light& light = scene.lights[size_t(source)];
  RayHit hit;
  if (!embree.intersect(ray.origin, ray.direction, std::numeric_limits<float>::infinity(), seed, hit)) {
    return {ray.origin, 0.0f, -ray.direction, VIRTUAL_LIGHT_REFLECTED, glm::vec3(0.0f), source};
  }
  const SurfacePoint at = surface_point(scene, scene.meshes[hit.mesh], hit.triangle, hit.u, hit.v);
  const float slope = glm::dot(at.geometric_normal, ray.direction);
  const bool sun = light.type == Light::Type::directional;
  const float window = sun ? 1.0f : shared::range_window(to_shared(light), hit.distance);
  const float squared = sun ? 1.0f : hit.distance * hit.distance;
  const float area_m2 = ray.measure * squared / std::max(std::abs(slope), kMinCosine);
  const glm::vec3 normal = slope < 0.0f ? at.geometric_normal : -at.geometric_normal;
  return {at.position, area_m2, normal, VIRTUAL_LIGHT_REFLECTED, ray.power * window * at.albedo * hit.tint, source};
}

std::vector<LightRay> rays_of(const Scene& scene, const Light& light, int count) {
  return light.type == Light::Type::directional ? rays_of_sun(scene, light, count) : rays_of_cone(light, count);
}

void order_along_curve(std::vector<LightRay>& rays) {
  std::vector<std::pair<std::uint32_t, size_t>> order(rays.size());
  for (size_t i = 0; i < rays.size(); ++i) order[i] = {hilbert_index(rays[i].place), i};
  std::sort(order.begin(), order.end());
  std::vector<LightRay> ordered;
  ordered.reserve(rays.size());
  for (const auto& [key, i] : order) ordered.push_back(rays[i]);
  rays = std::move(ordered);
}

VirtualLightsCpu make_lights(const EmbreeScene& embree, const EmitterPoints& emitters, const LightShares& shares,
                             bool ordered) {
  const Scene& scene = embree.scene();
  VirtualLightsCpu list;
  for (size_t i = 0; i < scene.lights.size(); ++i) {
    if (shares.of_light[i] == 0) continue;
    std::vector<LightRay> rays = rays_of(scene, scene.lights[i], shares.of_light[i]);
    if (ordered) order_along_curve(rays);
    const size_t first = list.lights.size();
    list.lights.resize(first + rays.size());
    oneapi::tbb::parallel_for(size_t(0), rays.size(), [&](size_t k) {
      list.lights[first + k] = end_of(embree, rays[k], int(i), std::uint32_t(first + k));
    });
  }
  list.reflected = int(list.lights.size());
  for (const EmitterPoint& p : emitters.points(shares.of_emitters)) {
    list.lights.push_back({p.position, p.area_m2, p.normal, VIRTUAL_LIGHT_EMITTED, p.flux, -1});
  }
  return list;
}

}  // namespace

VirtualLightsCpu virtual_lights_cpu(const EmbreeScene& embree, const EmitterPoints& emitters, int count,
                                    bool along_curve) {
  assert(count >= 1);
  return make_lights(embree, emitters, share_by_power(embree.scene(), emitters.flux(), count, false), along_curve);
}

}  // namespace volgi
