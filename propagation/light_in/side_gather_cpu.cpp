#include "propagation/light_in/side_gather_cpu.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>

#include "core/octahedral.h"
#include "propagation/light_in/side_start_internal.h"
#include "propagation/side_loops.h"
#include "shaders/shared/disk_to_point.shared.h"

namespace volgi {

namespace {

using shared::Side;
using shared::VirtualLight;

/// A light or a sub-light of one, as a side sees it.
struct Disk {
  glm::vec3 position, normal, flux;
  float area_m2;
};

constexpr float FAR = std::numeric_limits<float>::infinity();
constexpr size_t FINE_PER_COARSE = FINE_SUBLIGHTS / COARSE_SUBLIGHTS;
constexpr size_t GROUP = 64;  // sides that look for lights near them together

Disk disk_of(const shared::SubLight& l) { return {l.position, octahedral_decode(l.normal), l.flux, l.area_m2}; }
Disk disk_of(const VirtualLight& l) { return {l.position, l.normal, l.flux, l.area_m2}; }

/// As if nothing were in between.
glm::vec3 irradiance_of(const Side& side, const SideStart& start, const Disk& light) {
  const glm::vec3 to_light = light.position - start.position;
  const float along_side = glm::dot(to_light, side.normal), along_light = -glm::dot(to_light, light.normal);
  const bool dark = light.flux == glm::vec3(0.0f);
  if (dark || !(along_side > 0.0f) || !(along_light > 0.0f)) return glm::vec3(0.0f);
  const float facing = -glm::dot(light.normal, side.normal), squared = glm::dot(to_light, to_light);
  return light.flux * shared::disk_to_point(along_light, along_side, facing, squared, light.area_m2);
}

/// Share of a disk's light at a point that comes from itself and not from what it consists of.
float far_share_at(glm::vec3 point, const Disk& light, float zone) {
  const glm::vec3 way = light.position - point;
  return shared::far_share(shared::disk_nearness(glm::dot(way, way), light.area_m2), zone);
}

struct Box {
  glm::vec3 least{FAR}, most{-FAR};
  void add(glm::vec3 p) {
    least = glm::min(least, p);
    most = glm::max(most, p);
  }
};

/// Lights and their sub-lights as disks, with the ends of rays to them; what a side takes of both.
class Gather {
 public:
  Gather(const EmbreeScene& embree, const VirtualLightsForSides& from, size_t first, size_t end, int stride)
      : embree_(embree),
        zone_(from.sublights.empty() ? 0.0f : from.near_zone),
        apart_(from.sample > 0),
        stride_(size_t(stride)) {
    for (size_t k = first; k < end; ++k) {
      lights_.push_back(disk_of(from.lights[k]));
      light_ends_.push_back(end_of(lights_.back()));
      if (from.sublights.empty()) continue;
      reaches_.push_back(reach_of(from, k));
      for (size_t p = 0; p < SUBLIGHTS_PER_LIGHT; ++p) {
        sublights_.push_back(disk_of(from.sublights[k * SUBLIGHTS_PER_LIGHT + p]));
        if (p < COARSE_SUBLIGHTS) coarse_ends_.push_back(end_of(sublights_.back()));
      }
    }
  }

  /// Lights of which sub-lights reach into the box.
  std::vector<std::uint32_t> near_lights(const Box& box) const {
    std::vector<std::uint32_t> near;
    for (size_t k = 0; k < lights_.size() && !sublights_.empty(); ++k) {
      const glm::vec3 d = glm::clamp(lights_[k].position, box.least, box.most) - lights_[k].position;
      if (glm::dot(d, d) < reaches_[k] * reaches_[k]) near.push_back(std::uint32_t(k));
    }
    return near;
  }

  /// Of every stride-th light from `offset` on, as far as they shine themselves.
  glm::vec3 from_lights(const Side& side, const SideStart& start, size_t offset, std::uint32_t seed) const {
    glm::vec3 sum(0.0f);
    for (size_t k = offset; k < lights_.size(); k += stride_) {
      Disk light = lights_[k];
      const float share = sublights_.empty() ? 1.0f : far_share_at(start.position, light, zone_);
      if (share <= 0.0f) continue;
      // Peaks near a light are its sub-lights'.
      if (sublights_.empty()) light.area_m2 += std::min(float(stride_ - 1) * light.area_m2, side.area_m2);
      const glm::vec3 own = share * irradiance_of(side, start, light);
      if (own != glm::vec3(0.0f)) sum += own * passed(start, light_ends_[k], seed + std::uint32_t(k));
    }
    return sum * float(stride_);
  }

  /// Of a light's sub-lights, by the share that it does not have itself: its coarse ones, and nearer by half the fine
  /// ones of those, as near_lights.comp.glsl has it. A ray for each coarse one.
  glm::vec3 from_sublights(const Side& side, const SideStart& start, size_t light, std::uint32_t seed) const {
    const float near = apart_ ? 1.0f : 1.0f - far_share_at(start.position, lights_[light], zone_);
    if (near <= 0.0f) return glm::vec3(0.0f);
    const auto own_share = [&](const Disk& sublight) {
      Disk as_light = sublight;
      as_light.area_m2 = lights_[light].area_m2;
      return apart_ ? 1.0f - far_share_at(start.position, as_light, zone_) : 1.0f;
    };
    const Disk* sublights = &sublights_[light * SUBLIGHTS_PER_LIGHT];
    glm::vec3 sum(0.0f);
    for (size_t coarse = 0; coarse < COARSE_SUBLIGHTS; ++coarse) {
      const float far = far_share_at(start.position, sublights[coarse], zone_);
      glm::vec3 own(0.0f);
      const float coarse_share = far > 0.0f ? far * own_share(sublights[coarse]) : 0.0f;
      if (coarse_share > 0.0f) own += coarse_share * irradiance_of(side, start, sublights[coarse]);
      for (size_t k = 0; k < FINE_PER_COARSE && far < 1.0f; ++k) {
        const Disk& fine = sublights[COARSE_SUBLIGHTS + coarse * FINE_PER_COARSE + k];
        const float fine_share = (1.0f - far) * own_share(fine);
        if (fine_share > 0.0f) own += fine_share * irradiance_of(side, start, fine);
      }
      if (own == glm::vec3(0.0f)) continue;
      const glm::vec3 end = coarse_ends_[light * COARSE_SUBLIGHTS + coarse];
      sum += own * passed(start, end, seed + std::uint32_t(light));
    }
    return near * sum;
  }

 private:
  /// Farther away far_share() is 1, of the light or of all that it consists of.
  float reach_of(const VirtualLightsForSides& from, size_t light) const {
    const VirtualLight& whole = from.lights[light];
    float squared = 0.0f;
    for (size_t p = 0; p < SUBLIGHTS_PER_LIGHT && apart_; ++p) {
      const shared::SubLight& part = from.sublights[light * SUBLIGHTS_PER_LIGHT + p];
      const glm::vec3 d = part.position - whole.position;
      if (part.flux != glm::vec3(0.0f)) squared = std::max(squared, glm::dot(d, d));
    }
    return std::sqrt(2.0f * zone_ * whole.area_m2) + std::sqrt(squared);
  }
  /// Of rays to a light: beside its surface.
  glm::vec3 end_of(const Disk& light) const { return embree_.leaving_point(light.position, -light.normal, FAR); }
  glm::vec3 passed(const SideStart& start, glm::vec3 end, std::uint32_t seed) const {
    const glm::vec3 way = end - start.origin;
    const float distance = glm::length(way);
    if (!(distance > 0.0f)) return glm::vec3(1.0f);
    return embree_.passed({start.origin, way / distance, distance, seed, start.from, {}});
  }

  const EmbreeScene& embree_;
  float zone_;
  bool apart_;
  size_t stride_;
  std::vector<Disk> lights_, sublights_;
  std::vector<float> reaches_;  // of sub-lights [m]
  std::vector<glm::vec3> light_ends_, coarse_ends_;
};

}  // namespace

int automatic_stride(size_t sides, size_t lights) {
  constexpr size_t kRays = size_t(1) << 19;
  constexpr size_t kLargest = 32;
  return int(std::clamp((sides * lights + kRays - 1) / kRays, size_t(1), kLargest));
}

std::vector<glm::vec4> side_gather(const VoxelGrid& voxels, const EmbreeScene& embree,
                                   const VirtualLightsForSides& from, size_t first, size_t end, int stride) {
  assert(stride >= 1 && end <= from.lights.size());
  assert(from.sublights.empty() || from.sublights.size() >= from.lights.size() * SUBLIGHTS_PER_LIGHT);
  const Gather gather(embree, from, first, end, stride);
  std::vector<glm::vec4> irradiance(voxels.side_count());
  const auto gather_group = [&](size_t begin, size_t past) {
    std::array<SideStart, GROUP> starts;
    Box box;
    for (size_t i = begin; i < past; ++i) {
      starts[i - begin] = start_of_side(voxels, embree, voxels.sides()[i]);
      box.add(starts[i - begin].position);
    }
    const std::vector<std::uint32_t> near = gather.near_lights(box);
    for (size_t i = begin; i < past; ++i) {
      const Side& side = voxels.sides()[i];
      const glm::ivec3 cell = shared::cell_coord(voxels.grid(), side.cell);
      const std::uint32_t seed = std::uint32_t(i) * 2654435769u + std::uint32_t(from.sample) * 2246822519u;
      const auto offset = size_t(first_light_of_side(cell, side.face, stride, from.sample));
      glm::vec3 sum = gather.from_lights(side, starts[i - begin], offset, seed);
      for (const std::uint32_t k : near) sum += gather.from_sublights(side, starts[i - begin], k, seed);
      irradiance[i] = glm::vec4(sum, 0.0f);
    }
  };
  tbb::parallel_for(size_t(0), (irradiance.size() + GROUP - 1) / GROUP, [&](size_t group) {
    gather_group(group * GROUP, std::min((group + 1) * GROUP, irradiance.size()));
  });
  return irradiance;
}

std::vector<glm::vec4> reflected_flux(const VoxelGrid& voxels, std::span<const glm::vec4> irradiance) {
  assert(irradiance.size() == voxels.side_count());
  std::vector<glm::vec4> flux(irradiance.size());
  for_each_side(flux.size(), [&](size_t i) {
    const Side& side = voxels.sides()[i];
    flux[i] = glm::vec4(glm::vec3(irradiance[i]) * side.albedo * side.area_m2, 0.0f);
  });
  return flux;
}

SideFlux flux_after_first_bounce(const VoxelGrid& voxels, const EmbreeScene& embree, const VirtualLightsForSides& from,
                                 bool emission_apart, std::optional<int> stride) {
  const size_t all = from.lights.size(), reflected = emission_apart ? size_t(from.reflected) : all;
  const int step = stride.value_or(automatic_stride(voxels.side_count(), all));
  const auto brought_by = [&](size_t first, size_t end) {
    return reflected_flux(voxels, side_gather(voxels, embree, from, first, end, step));
  };
  SideFlux flux;
  flux.emitted.assign(voxels.side_count(), glm::vec4(0.0f));
  flux.punctual = brought_by(0, reflected);
  flux.emits = reflected < all;
  if (flux.emits) flux.emitted = brought_by(reflected, all);
  return flux;
}

}  // namespace volgi
