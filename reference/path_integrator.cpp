#include "reference/path_integrator.h"

#include <algorithm>
#include <cmath>

#include "core/light.h"

namespace volgi {
namespace {

constexpr float kPi = 3.14159265358979f;
constexpr int kPairsPerVertex = 8;        // dimensions set aside for one vertex (PathSampler::seek)
constexpr int kRouletteFrom = 3;          // bounces that always go on
constexpr float kRouletteBelow = 0.125f;  // throughput; measured: 4 times less variance per second than 1 at albedo 0.8
constexpr float kLargestSurvival = 0.99f;  // ends paths between white walls
constexpr size_t kFewLights = 2;           // up to here every vertex asks every light
constexpr float kLightEnd = 1.0f - 4e-6f;  // shadow rays stop short of the surface that a light sits on

float largest(glm::vec3 c) { return std::max({c.x, c.y, c.z}); }

// Duff et al. 2017, "Building an Orthonormal Basis, Revisited".
glm::vec3 around_normal(glm::vec3 local, glm::vec3 n) {
  const float sign = std::copysign(1.0f, n.z);
  const float a = -1.0f / (sign + n.z), b = n.x * n.y * a;
  const glm::vec3 t(1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x), s(b, sign + n.y * n.y * a, -n.y);
  return local.x * t + local.y * s + local.z * n;
}

// Density cos/pi per solid angle; Shirley and Chiu's concentric map keeps the strata of the square.
glm::vec3 cosine_direction(glm::vec2 xi, glm::vec3 normal) {
  const glm::vec2 p = 2.0f * xi - 1.0f;
  glm::vec2 disk(0.0f);
  if (std::abs(p.x) > std::abs(p.y)) {
    const float angle = kPi / 4 * (p.y / p.x);
    disk = p.x * glm::vec2(std::cos(angle), std::sin(angle));
  } else if (p.y != 0.0f) {
    const float angle = kPi / 2 - kPi / 4 * (p.x / p.y);
    disk = p.y * glm::vec2(std::cos(angle), std::sin(angle));
  }
  const float z = std::sqrt(std::max(0.0f, 1.0f - glm::dot(disk, disk)));
  return glm::normalize(around_normal({disk, z}, normal));
}

float power_heuristic(float mine, float other) {
  if (!(mine > 0.0f)) return 0.0f;
  const float ratio = other / mine;  // squares of huge densities would overflow
  return 1.0f / (1.0f + ratio * ratio);
}

// Lambertian reflection of light from `to_light`: albedo/pi times cosine; zero where either normal says "behind".
glm::vec3 reflected(const PathVertex& vertex, glm::vec3 to_light) {
  const float cosine = glm::dot(vertex.shading_normal, to_light);
  if (cosine <= 0.0f || glm::dot(vertex.geometric_normal, to_light) <= 0.0f) return glm::vec3(0.0f);
  return vertex.surface.albedo * (cosine / kPi);
}

}  // namespace

PathIntegrator::PathIntegrator(const Scene& scene) : scene_(&scene), rays_(scene), emitters_(scene) {
  set_lights(scene.lights);
  for (const Mesh& mesh : scene.meshes)
    has_blending_ |= scene.materials[static_cast<size_t>(mesh.material)].alpha_mode == AlphaMode::blend;
}

void PathIntegrator::set_lights(const std::vector<Light>& lights) {
  lights_.clear();
  for (const Light& light : lights) lights_.push_back(to_shared(light));
}

bool PathIntegrator::next_vertex(const Ray& ray, PathVertex& vertex) const {
  RayHit hit;
  if (!rays_.intersect(ray, hit)) return false;
  const Mesh& mesh = scene_->meshes[hit.mesh];
  vertex.triangle = hit.index();
  vertex.distance = hit.distance;
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

bool PathIntegrator::visible(const PathVertex& vertex, glm::vec3 to_light, float distance, std::uint32_t seed) const {
  return !rays_.occluded({vertex.start, to_light, distance * kLightEnd, seed, vertex.triangle, {}});
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
    if (radiance != glm::vec3(0.0f) && visible(vertex, to_light, distance, hash(seed, static_cast<std::uint32_t>(i))))
      sum += radiance;
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
    if (faces_it && irradiance != glm::vec3(0.0f) && visible(vertex, to_light, distance, alpha_seed))
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
  if (!(total > 0.0f) || !visible(vertex, chosen_direction, chosen_distance, seed)) return glm::vec3(0.0f);
  return chosen * (total / chosen_weight);
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
  if (rays_.occluded({vertex.start, to_light, distance * kLightEnd, seed, vertex.triangle, light.triangle}))
    return glm::vec3(0.0f);
  const float pdf_light = light.pdf_area * (distance * distance / std::abs(cosine));
  const float pdf_hemisphere = glm::dot(vertex.shading_normal, to_light) / kPi;
  return reflection * light.radiance * (power_heuristic(pdf_light, pdf_hemisphere) / pdf_light);
}

glm::vec3 PathIntegrator::gather(const PathVertex& vertex, bool first, PathSampler& sampler) const {
  glm::vec3 sum(0.0f);
  if (vertex.surface.albedo == glm::vec3(0.0f)) return sum;
  if (!lights_.empty())
    sum = first || lights_.size() <= kFewLights ? all_punctual(vertex, sampler) : one_punctual(vertex, sampler);
  if (!emitters_.empty()) sum += emitters(vertex, sampler);
  return sum;
}

// Share of emission that the hemisphere's ray may count, the rest comes from emitters().
float PathIntegrator::emitter_weight(const PathVertex& hit, glm::vec3 direction, float pdf_direction) const {
  const float cosine = std::abs(glm::dot(hit.geometric_normal, direction));
  if (cosine <= 0.0f) return 1.0f;
  return power_heuristic(pdf_direction, emitters_.pdf_area(hit.triangle) * (hit.distance * hit.distance / cosine));
}

PathRadiance PathIntegrator::trace(const PathVertex& first, PathSampler& sampler, int max_bounces) const {
  PathRadiance sum{first.emission, glm::vec3(0.0f)};
  PathVertex vertex = first;
  glm::vec3 throughput(1.0f);
  for (int bounce = 0;; ++bounce) {
    glm::vec3& target = bounce == 0 ? sum.direct : sum.indirect;
    sampler.seek(static_cast<std::uint32_t>(2 + bounce * kPairsPerVertex));
    const glm::vec2 xi = sampler.next2();
    const float survival_xi = sampler.next1();
    const std::uint32_t alpha_seed = sampler.next_seed();
    target += throughput * gather(vertex, bounce == 0, sampler);
    const bool last = bounce == max_bounces;
    if (last && emitters_.empty()) break;

    throughput *= vertex.surface.albedo;
    if (bounce >= kRouletteFrom && !last) {
      const float survival = std::min(largest(throughput) / kRouletteBelow, kLargestSurvival);
      if (!(survival_xi < survival)) break;
      throughput /= survival;
    }
    const glm::vec3 direction = cosine_direction(xi, vertex.shading_normal);
    const float cosine = glm::dot(vertex.shading_normal, direction);
    if (largest(throughput) <= 0.0f || cosine <= 0.0f || glm::dot(vertex.geometric_normal, direction) <= 0.0f) break;
    const Ray ray{vertex.start, direction, std::numeric_limits<float>::infinity(), alpha_seed, vertex.triangle, {}};
    if (!next_vertex(ray, vertex)) break;
    if (vertex.emission != glm::vec3(0.0f))
      target += throughput * vertex.emission * emitter_weight(vertex, direction, cosine / kPi);
    if (last) break;
  }
  return sum;
}

}  // namespace volgi
