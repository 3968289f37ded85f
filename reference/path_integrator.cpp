#include "reference/path_integrator.h"

#include <algorithm>
#include <cmath>

#include "core/light.h"

namespace volgi {
namespace {

constexpr int kPairsPerVertex = 12;       // dimensions set aside for one vertex (PathSampler::seek)
constexpr int kRouletteFrom = 3;          // bounces that always go on
constexpr float kRouletteBelow = 0.125f;  // throughput; measured: 4 times less variance per second than 1 at albedo 0.8
constexpr float kLargestSurvival = 0.99f;  // ends paths between white walls
constexpr size_t kFewLights = 2;           // up to here every vertex asks every light
constexpr float kLightEnd = 1.0f - 4e-6f;  // shadow rays stop short of the surface that a light sits on

float largest(glm::vec3 c) { return std::max({c.x, c.y, c.z}); }

float power_heuristic(float mine, float other) {
  if (!(mine > 0.0f)) return 0.0f;
  const float ratio = other / mine;  // squares of huge densities would overflow
  return 1.0f / (1.0f + ratio * ratio);
}

// What comes back towards the viewer of light from `to_light`: the cosine is in it; zero where either normal says
// "behind".
glm::vec3 reflected(const PathVertex& vertex, glm::vec3 to_light) {
  if (glm::dot(vertex.geometric_normal, to_light) <= 0.0f) return glm::vec3(0.0f);
  return Scattering(vertex.surface).reflected(vertex.shading_normal, vertex.to_viewer, to_light);
}

float pdf_of_path(const PathVertex& vertex, glm::vec3 to_light) {
  return Scattering(vertex.surface).pdf(vertex.shading_normal, vertex.to_viewer, to_light);
}

}  // namespace

PathIntegrator::PathIntegrator(const Scene& scene) : scene_(&scene), rays_(scene), emitters_(scene) {
  set_lights(scene.lights);
  if (scene.sky && !scene.sky->constant()) sky_.emplace(*scene.sky);
  for (const Mesh& mesh : scene.meshes)
    has_blending_ |= scene.materials[static_cast<size_t>(mesh.material)].passes_by_chance();
}

void PathIntegrator::set_lights(const std::vector<Light>& lights) {
  lights_.clear();
  for (const Light& light : lights) lights_.push_back(to_shared(light));
}

bool PathIntegrator::next_vertex(const Ray& ray, PathVertex& vertex) const {
  RayHit hit;
  const bool met = rays_.intersect(ray, hit);
  vertex.tint = hit.tint;
  if (!met) return false;
  const Mesh& mesh = scene_->meshes[hit.mesh];
  vertex.triangle = hit.index();
  vertex.distance = hit.distance;
  vertex.to_viewer = -ray.direction;
  vertex.surface = surface_point(*scene_, mesh, hit.triangle, hit.u, hit.v);
  const SurfacePoint& s = vertex.surface;
  const bool front = glm::dot(s.geometric_normal, ray.direction) < 0.0f;
  vertex.geometric_normal = front ? s.geometric_normal : -s.geometric_normal;
  vertex.shading_normal = front ? s.shading_normal : -s.shading_normal;
  // Also catches normals that are not a number.
  if (!(glm::dot(vertex.shading_normal, vertex.geometric_normal) > 0.0f))
    vertex.shading_normal = vertex.geometric_normal;
  const bool emits = front || scene_->materials[static_cast<size_t>(mesh.material)].double_sided;
  vertex.emission = emits ? s.emission : glm::vec3(0.0f);
  vertex.start = rays_.leaving_point(s.position, ray.direction, hit.distance);
  return true;
}

bool PathIntegrator::first_vertex(const CameraRay& ray, std::uint32_t alpha_seed, PathVertex& vertex) const {
  Ray from_camera;
  from_camera.origin = ray.origin;
  from_camera.direction = ray.direction;
  from_camera.alpha_seed = alpha_seed;
  return next_vertex(from_camera, vertex);
}

// Share of light that arrives.
glm::vec3 PathIntegrator::visible(const PathVertex& vertex, glm::vec3 to_light, float distance,
                                  std::uint32_t seed) const {
  return rays_.passed({vertex.start, to_light, distance * kLightEnd, seed, vertex.triangle, {}});
}

// Radiance that the light causes towards the viewer when nothing is in between.
glm::vec3 PathIntegrator::punctual_light(const PathVertex& vertex, const shared::PunctualLight& light,
                                         glm::vec3& to_light, float& distance) const {
  const glm::vec3 irradiance = shared::perpendicular_irradiance(light, vertex.surface.position, to_light);
  distance = light.type == LIGHT_DIRECTIONAL ? std::numeric_limits<float>::infinity()
                                             : glm::length(light.position - vertex.surface.position);
  return reflected(vertex, to_light) * irradiance;
}

glm::vec3 PathIntegrator::all_punctual(const PathVertex& vertex, PathSampler& sampler) const {
  glm::vec3 sum(0.0f);
  const std::uint32_t seed = sampler.next_seed();
  for (size_t i = 0; i < lights_.size(); ++i) {
    glm::vec3 to_light;
    float distance = 0.0f;
    const glm::vec3 radiance = punctual_light(vertex, lights_[i], to_light, distance);
    if (radiance != glm::vec3(0.0f))
      sum += radiance * visible(vertex, to_light, distance, hash(seed, static_cast<std::uint32_t>(i)));
  }
  return sum;
}

std::uint32_t PathIntegrator::lights_reaching(const PathVertex& vertex, std::uint32_t alpha_seed) const {
  constexpr size_t bits_in_float = 24;
  std::uint32_t bits = 0;
  for (size_t i = 0; i < lights_.size(); ++i) {
    const shared::PunctualLight& light = lights_[i];
    glm::vec3 to_light;
    const glm::vec3 irradiance = shared::perpendicular_irradiance(light, vertex.surface.position, to_light);
    const float distance = light.type == LIGHT_DIRECTIONAL ? std::numeric_limits<float>::infinity()
                                                           : glm::length(light.position - vertex.surface.position);
    const bool faces_it =
        glm::dot(vertex.shading_normal, to_light) > 0.0f && glm::dot(vertex.geometric_normal, to_light) > 0.0f;
    if (faces_it && irradiance != glm::vec3(0.0f) && visible(vertex, to_light, distance, alpha_seed) != glm::vec3(0.0f))
      bits |= 1u << i % bits_in_float;
  }
  return bits;
}

// One light, chosen in proportion to what it would send unshadowed (a reservoir of one, so lights are read once).
glm::vec3 PathIntegrator::one_punctual(const PathVertex& vertex, PathSampler& sampler) const {
  float xi = sampler.next1(), total = 0.0f, chosen_weight = 0.0f, chosen_distance = 0.0f;
  glm::vec3 chosen(0.0f), chosen_direction(0.0f);
  for (const shared::PunctualLight& light : lights_) {
    glm::vec3 to_light;
    float distance = 0.0f;
    const glm::vec3 radiance = punctual_light(vertex, light, to_light, distance);
    const float weight = largest(glm::abs(radiance));
    if (!(weight > 0.0f)) continue;
    total += weight;
    const float p = weight / total;
    if (xi < p) {
      chosen = radiance, chosen_direction = to_light, chosen_distance = distance, chosen_weight = weight;
      xi /= p;
    } else {
      xi = (xi - p) / (1.0f - p);
    }
  }
  const std::uint32_t seed = sampler.next_seed();
  if (!(total > 0.0f)) return glm::vec3(0.0f);
  return chosen * (total / chosen_weight) * visible(vertex, chosen_direction, chosen_distance, seed);
}

glm::vec3 PathIntegrator::emitters(const PathVertex& vertex, PathSampler& sampler) const {
  const glm::vec2 uv = sampler.next2();
  const EmitterSample light = emitters_.sample(uv, sampler.next1());
  const std::uint32_t seed = sampler.next_seed();
  if (light.pdf_area <= 0.0f || light.triangle == vertex.triangle) return glm::vec3(0.0f);
  const glm::vec3 between = light.position - vertex.start;
  const float distance = glm::length(between);
  if (!(distance > 0.0f)) return glm::vec3(0.0f);
  const glm::vec3 to_light = between / distance;
  const float cosine = -glm::dot(light.normal, to_light);
  const glm::vec3 reflection = reflected(vertex, to_light);
  if ((cosine <= 0.0f && !light.double_sided) || cosine == 0.0f || reflection == glm::vec3(0.0f))
    return glm::vec3(0.0f);
  const glm::vec3 arrives =
      rays_.passed({vertex.start, to_light, distance * kLightEnd, seed, vertex.triangle, light.triangle});
  const float pdf_light = light.pdf_area * (distance * distance / std::abs(cosine));
  return reflection * arrives * light.radiance *
         (power_heuristic(pdf_light, pdf_of_path(vertex, to_light)) / pdf_light);
}

glm::vec3 PathIntegrator::sky(const PathVertex& vertex, PathSampler& sampler) const {
  const SkySample light = sky_->sample(sampler.next2());
  const std::uint32_t seed = sampler.next_seed();
  const glm::vec3 reflection = light.pdf > 0.0f ? reflected(vertex, light.towards) : glm::vec3(0.0f);
  if (reflection == glm::vec3(0.0f)) return glm::vec3(0.0f);
  const float far = std::numeric_limits<float>::infinity();
  const glm::vec3 arrives = rays_.passed({vertex.start, light.towards, far, seed, vertex.triangle, {}});
  return reflection * arrives * light.radiance *
         (power_heuristic(light.pdf, pdf_of_path(vertex, light.towards)) / light.pdf);
}

glm::vec3 PathIntegrator::background(glm::vec3 direction) const {
  return scene_->sky ? scene_->sky->radiance(direction) : glm::vec3(0.0f);
}

glm::vec3 PathIntegrator::gather(const PathVertex& vertex, bool first, PathSampler& sampler) const {
  glm::vec3 sum(0.0f);
  if (Scattering(vertex.surface).black()) return sum;
  if (!lights_.empty())
    sum = first || lights_.size() <= kFewLights ? all_punctual(vertex, sampler) : one_punctual(vertex, sampler);
  if (!emitters_.empty()) sum += emitters(vertex, sampler);
  if (sky_) sum += sky(vertex, sampler);
  return sum;
}

// Share of the sky that the path's own ray may count.
float PathIntegrator::sky_weight(glm::vec3 direction, float pdf_direction) const {
  return sky_ ? power_heuristic(pdf_direction, sky_->pdf(direction)) : 1.0f;
}

// Share of emission that the hemisphere's ray may count, the rest comes from emitters().
float PathIntegrator::emitter_weight(const PathVertex& hit, glm::vec3 direction, float pdf_direction) const {
  const float cosine = std::abs(glm::dot(hit.geometric_normal, direction));
  if (cosine <= 0.0f) return 1.0f;
  return power_heuristic(pdf_direction, emitters_.pdf_area(hit.triangle) * (hit.distance * hit.distance / cosine));
}

PathRadiance PathIntegrator::trace(const PathVertex& first, PathSampler& sampler, int max_bounces) const {
  PathRadiance sum{first.tint * (first.emission + first.surface.unlit), glm::vec3(0.0f)};
  PathVertex vertex = first;
  glm::vec3 throughput = first.tint;
  for (int bounce = 0;; ++bounce) {
    glm::vec3& target = bounce == 0 ? sum.direct : sum.indirect;
    sampler.seek(static_cast<std::uint32_t>(2 + bounce * kPairsPerVertex));
    const glm::vec2 xi = sampler.next2();
    const float survival_xi = sampler.next1(), part_xi = sampler.next1();
    const std::uint32_t alpha_seed = sampler.next_seed();
    target += throughput * gather(vertex, bounce == 0, sampler);
    const bool last = bounce == max_bounces;
    if (last && !sees_light()) break;

    const Scattering scattering(vertex.surface);
    const glm::vec3 direction = scattering.sample(vertex.shading_normal, vertex.to_viewer, xi, part_xi);
    const float pdf = scattering.pdf(vertex.shading_normal, vertex.to_viewer, direction);
    if (!(pdf > 0.0f) || glm::dot(vertex.geometric_normal, direction) <= 0.0f) break;
    throughput *= scattering.reflected(vertex.shading_normal, vertex.to_viewer, direction) / pdf;
    if (bounce >= kRouletteFrom && !last) {
      const float survival = std::min(largest(throughput) / kRouletteBelow, kLargestSurvival);
      if (!(survival_xi < survival)) break;
      throughput /= survival;
    }
    if (!(largest(throughput) > 0.0f)) break;
    const Ray ray{vertex.start, direction, std::numeric_limits<float>::infinity(), alpha_seed, vertex.triangle, {}};
    const bool met = next_vertex(ray, vertex);
    throughput *= vertex.tint;
    if (!met) {
      if (scene_->sky) target += throughput * background(direction) * sky_weight(direction, pdf);
      break;
    }
    if (vertex.emission != glm::vec3(0.0f))
      target += throughput * vertex.emission * emitter_weight(vertex, direction, pdf);
    if (last) break;
  }
  return sum;
}

}  // namespace volgi
