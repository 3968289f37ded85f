#include "propagation/light_in/reflected_flux_cpu.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "core/octahedral.h"
#include "core/surface.h"
#include "propagation/light_in/cosine_direction_internal.h"

namespace volgi {

namespace {

constexpr float FAR = std::numeric_limits<float>::infinity();

/// A light or a sub-light of one.
struct Sender {
  glm::vec3 origin, normal, flux;
};

float weight_of(const Sender& s) { return s.flux.x + s.flux.y + s.flux.z; }

/// Where rays of a light at `position` start: off its surface, which positions miss by 2^-20 of their numbers (as
/// shared/reflective_shadow_map.glsl has it), and back on the way on which its light came. That way is free: in a
/// corner, what lies off one wall may lie behind the other.
glm::vec3 origin_of(const EmbreeScene& embree, glm::vec3 position, glm::vec3 normal, int source) {
  const Scene& scene = embree.scene();
  const float off_m = 0x1p-19f * glm::length(glm::max(glm::abs(scene.bounds_min), glm::abs(scene.bounds_max)));
  glm::vec3 way = -normal;
  float length_m = FAR;
  if (source >= 0 && size_t(source) < scene.lights.size()) {  // not the sky, nor emission
    const Light& light = scene.lights[size_t(source)];
    const glm::vec3 from_light = position - light.position;
    const bool sun = light.type == Light::Type::directional;
    length_m = sun ? FAR : glm::length(from_light);
    way = sun ? light.direction : from_light / length_m;
  }
  return embree.leaving_point(position, way, length_m) + off_m * normal;
}

std::vector<Sender> senders_of(const EmbreeScene& embree, const VirtualLightsForSides& from, size_t first, size_t end) {
  std::vector<Sender> senders;
  for (size_t k = first; k < end; ++k) {
    const shared::VirtualLight& light = from.lights[k];
    const auto add = [&](glm::vec3 position, glm::vec3 normal, glm::vec3 flux) {
      senders.push_back({origin_of(embree, position, normal, light.source), normal, flux});
    };
    if (from.sublights.empty()) add(light.position, light.normal, light.flux);
    for (size_t p = COARSE_SUBLIGHTS; p < SUBLIGHTS_PER_LIGHT && !from.sublights.empty(); ++p) {
      const shared::SubLight& l = from.sublights[k * SUBLIGHTS_PER_LIGHT + p];
      add(l.position, octahedral_decode(l.normal), l.flux);
    }
  }
  std::erase_if(senders, [](const Sender& s) { return !(weight_of(s) > 0.0f); });
  return senders;
}

/// A ray of a sender, and what it has met.
struct Carried {
  glm::vec3 way, flux;
  RayHit hit;
};

/// Calls take(j, Carried) for each ray that meets something, on all threads.
template <class Take>
void carry(const EmbreeScene& embree, const std::vector<Sender>& senders, int sample, size_t rays, const Take& take) {
  std::vector<double> sums;  // of all up to each
  for (const Sender& s : senders) sums.push_back((sums.empty() ? 0.0 : sums.back()) + double(weight_of(s)));
  if (senders.empty()) return;
  tbb::parallel_for(size_t(0), rays, [&](size_t j) {
    const double at = (double(j) + 0.5) / double(rays) * sums.back();
    const Sender& s = senders[size_t(std::upper_bound(sums.begin(), sums.end() - 1, at) - sums.begin())];
    const auto n = std::uint32_t(j + size_t(sample) * rays);
    Carried c{cosine_direction(s.normal, recurrence_in_square(n)),
              s.flux * (float(sums.back() / double(rays)) / weight_of(s)),
              {}};
    if (embree.intersect({s.origin, c.way, FAR, n, {}, {}}, c.hit)) take(j, c);
  });
}

FluxSample reflected(const Scene& scene, const Carried& c) {
  const SurfacePoint at = surface_point(scene, scene.meshes[c.hit.mesh], c.hit.triangle, c.hit.u, c.hit.v);
  const bool front = glm::dot(at.geometric_normal, c.way) < 0.0f;
  return {at.position, front ? at.geometric_normal : -at.geometric_normal, c.flux * c.hit.tint * at.albedo};
}

}  // namespace

size_t automatic_rays(size_t sides) { return std::clamp(8 * sides, size_t(1) << 16, size_t(1) << 19); }

std::vector<FluxSample> reflected_flux(const EmbreeScene& embree, const VirtualLightsForSides& from, size_t first,
                                       size_t end, size_t rays) {
  assert(end <= from.lights.size());
  assert(from.sublights.empty() || from.sublights.size() >= from.lights.size() * SUBLIGHTS_PER_LIGHT);
  std::vector<FluxSample> samples(rays, FluxSample{});
  carry(embree, senders_of(embree, from, first, end), from.sample, rays,
        [&](size_t j, const Carried& c) { samples[j] = reflected(embree.scene(), c); });
  std::erase_if(samples, [](const FluxSample& s) { return s.flux == glm::vec3(0.0f); });
  return samples;
}

std::vector<Flight> flights(const EmbreeScene& embree, const VirtualLightsForSides& from, size_t rays) {
  std::vector<Flight> found(rays, Flight{});
  carry(embree, senders_of(embree, from, 0, from.lights.size()), from.sample, rays, [&](size_t j, const Carried& c) {
    found[j] = {c.hit.distance, c.flux.x + c.flux.y + c.flux.z};
  });
  std::erase_if(found, [](const Flight& f) { return !(f.power > 0.0f); });
  return found;
}

SideFlux flux_after_first_bounce(const VolumeSides& sides, const EmbreeScene& embree, const VirtualLightsForSides& from,
                                 bool emission_apart, std::optional<size_t> rays) {
  const size_t all = from.lights.size(), reflected = emission_apart ? size_t(from.reflected) : all;
  const size_t count = rays.value_or(automatic_rays(sides.count()));
  SideFlux flux;
  flux.emitted.assign(sides.count(), glm::vec4(0.0f));
  flux.punctual = flux.emitted;
  flux.emits = reflected < all;
  deposit(sides, reflected_flux(embree, from, 0, reflected, count), flux.punctual, flux.lost);
  deposit(sides, reflected_flux(embree, from, reflected, all, count), flux.emitted, flux.lost);
  return flux;
}

}  // namespace volgi
