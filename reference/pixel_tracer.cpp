#include "reference/pixel_tracer.h"

namespace volgi {

using AskedLight = PathTracerOptions::Light;
namespace {
constexpr std::uint32_t kCentre = 0x5eed;  // chance of what is at pixels' centres, apart from that of samples
}

glm::dvec3 asked_for(const LightSum& sum, AskedLight light) {
  if (light == AskedLight::direct) return sum.direct;
  return light == AskedLight::indirect ? sum.indirect : sum.direct + sum.indirect;
}

PixelTracer::PixelTracer(const Scene& scene, const Camera& camera, const PathTracerOptions& options)
    : camera_(camera), options_(options), integrator_(scene) {
  options_changed();
}

void PixelTracer::options_changed() {
  max_bounces_ = options_.light == AskedLight::direct ? 0 : options_.max_bounces.value_or(PathIntegrator::unlimited);
  starts_at_centre_ = options_.filter == PathTracerOptions::Filter::point && !integrator_.has_blending();
}

bool PixelTracer::centre(glm::ivec2 pixel, CameraRay& ray, PathVertex& vertex) const {
  ray = camera_ray(camera_, glm::vec2(pixel) + 0.5f, options_.size);
  return integrator_.first_vertex(ray, hash(options_.seed, kCentre), vertex);
}

std::uint32_t PixelTracer::lights_reaching(const PathVertex& vertex) const {
  return integrator_.lights_reaching(vertex, hash(options_.seed, kCentre));
}

void PixelTracer::add_background(const CameraRay& ray, int count, LightSum& sum) const {
  sum.direct += double(count) * glm::dvec3(integrator_.background(ray.direction));
}

void PixelTracer::add_samples(glm::ivec2 pixel, const PathVertex* known, std::uint32_t point_set, int first, int count,
                              LightSum& sum) const {
  const std::uint32_t index = static_cast<std::uint32_t>(pixel.y) * static_cast<std::uint32_t>(options_.size.x) +
                              static_cast<std::uint32_t>(pixel.x);
  const std::uint32_t seed = hash(hash(options_.seed, index), point_set);
  for (int i = first; i < first + count; ++i)
    add_sample(glm::vec2(pixel), known, {seed, static_cast<std::uint32_t>(i)}, sum);
}

void PixelTracer::add_sample(glm::vec2 corner, const PathVertex* known, PathSampler sampler, LightSum& sum) const {
  PathVertex vertex;
  if (known == nullptr) {
    const bool box = options_.filter == PathTracerOptions::Filter::box;
    const glm::vec2 position = corner + (box ? sampler.next2() : glm::vec2(0.5f));
    const CameraRay ray = camera_ray(camera_, position, options_.size);
    if (!integrator_.first_vertex(ray, sampler.next_seed(), vertex)) {
      sum.direct += glm::dvec3(vertex.tint * integrator_.background(ray.direction));
      return;
    }
  }
  const PathRadiance radiance = integrator_.trace(known != nullptr ? *known : vertex, sampler, max_bounces_);
  sum.direct += glm::dvec3(radiance.direct);
  sum.indirect += glm::dvec3(radiance.indirect);
}

}  // namespace volgi
