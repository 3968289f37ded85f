#include "propagation/light_in/reflected_flux_cpu.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <span>

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
  size_t sender;
  glm::vec3 way, flux;  // flux: its part of the sender's
  RayHit hit;
};

/// Which senders have how many of the rays. Outside of a house the sun sends a hundred times of what it does in the one
/// room with a window, and rays by flux would all leave the scene. So every fourth ray goes by flux, and if any of them
/// meets nothing, of the others each sender has as many as it would of those that meet something.
class Sending {
 public:
  static constexpr size_t EVERY = 4;
  static constexpr size_t GROUP = 16;  // senders that count as one: they lie together

  explicit Sending(const std::vector<Sender>& senders)
      : senders_(senders), by_flux_(sums_of([](size_t) { return 1.0; })) {}

  size_t by_flux(double at) const { return chosen(by_flux_, at); }
  size_t by_meeting(double at) const { return chosen(by_meeting_.empty() ? by_flux_ : by_meeting_, at); }
  bool all_meet() const { return by_meeting_.empty(); }

  /// @param met  of `sent` for each group.
  void learn(std::span<const std::uint32_t> met, std::span<const std::uint32_t> sent) {
    if (std::equal(met.begin(), met.end(), sent.begin())) return;
    by_meeting_ = sums_of([&](size_t i) { return (double(met[i / GROUP]) + 1.0) / (double(sent[i / GROUP]) + 1.0); });
  }
  /// Of a sender's flux for each of its rays. Those that others were learnt from do not count then: a sender is asked
  /// more often where they met something, and would have less for it.
  float part(size_t sender, size_t rays, size_t others) const {
    const std::vector<double>& sums = all_meet() ? by_flux_ : by_meeting_;
    const double chance = (sums[sender] - (sender == 0 ? 0.0 : sums[sender - 1])) / sums.back();
    return float(1.0 / (double(all_meet() ? rays : others) * chance));
  }

 private:
  template <class Share>
  std::vector<double> sums_of(const Share& share) const {
    std::vector<double> sums;
    for (size_t i = 0; i < senders_.size(); ++i)
      sums.push_back((sums.empty() ? 0.0 : sums.back()) + double(weight_of(senders_[i])) * share(i));
    return sums;
  }
  static size_t chosen(const std::vector<double>& sums, double at) {
    return size_t(std::upper_bound(sums.begin(), sums.end() - 1, at * sums.back()) - sums.begin());
  }

  const std::vector<Sender>& senders_;
  std::vector<double> by_flux_, by_meeting_;  // the latter: none where all rays have met something
};

/// Calls take(j, Carried) for each ray that meets something, on all threads.
template <class Take>
void carry(const EmbreeScene& embree, const std::vector<Sender>& senders, int sample, size_t rays, const Take& take) {
  if (senders.empty() || rays == 0) return;
  Sending sending(senders);
  const auto trace = [&](size_t j, size_t sender, Carried& c) {
    const auto n = std::uint32_t(j + size_t(sample) * rays);
    const Sender& s = senders[sender];
    c = {sender, cosine_direction(s.normal, recurrence_in_square(n)), {}, {}};
    return embree.intersect({s.origin, c.way, FAR, n, {}, {}}, c.hit);
  };
  const size_t first = (rays + Sending::EVERY - 1) / Sending::EVERY, others = rays - first;
  std::vector<Carried> carried(first);
  std::vector<std::uint8_t> met(first);
  tbb::parallel_for(size_t(0), first, [&](size_t i) {
    const size_t j = i * Sending::EVERY;
    met[i] = trace(j, sending.by_flux((double(j) + 0.5) / double(rays)), carried[i]) ? 1 : 0;
  });
  std::vector<std::uint32_t> met_of((senders.size() - 1) / Sending::GROUP + 1), sent_of(met_of.size());
  for (size_t i = 0; i < first; ++i) {
    met_of[carried[i].sender / Sending::GROUP] += met[i];
    ++sent_of[carried[i].sender / Sending::GROUP];
  }
  sending.learn(met_of, sent_of);
  const auto take_part = [&](size_t j, Carried& c) {
    c.flux = senders[c.sender].flux * sending.part(c.sender, rays, others);
    take(j, c);
  };
  tbb::parallel_for(size_t(0), rays, [&](size_t j) {
    if (j % Sending::EVERY == 0) {
      if (sending.all_meet() && met[j / Sending::EVERY] != 0) take_part(j, carried[j / Sending::EVERY]);
      return;
    }
    // Where all have met something, as if there had been one way to choose.
    const size_t i = j - j / Sending::EVERY - 1;
    const double at = sending.all_meet() ? (double(j) + 0.5) / double(rays) : (double(i) + 0.5) / double(others);
    Carried c;
    if (trace(j, sending.by_meeting(at), c)) take_part(j, c);
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
