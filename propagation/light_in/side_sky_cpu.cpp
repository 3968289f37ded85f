#include "propagation/light_in/side_sky_cpu.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cassert>
#include <cstring>
#include <limits>

#include "propagation/light_in/side_start_internal.h"

namespace volgi {
namespace {

glm::vec3 irradiance_of(const VoxelGrid& voxels, const EmbreeScene& embree, size_t s, std::span<const SkyLight> parts,
                        int stride, int sample) {
  const shared::Side& side = voxels.sides()[s];
  const SideStart start = start_of_side(voxels, embree, side);
  const glm::ivec3 cell = shared::cell_coord(voxels.grid(), side.cell);
  glm::vec3 sum(0.0f);
  for (size_t k = size_t(first_part_of_side(cell, side.face, stride, sample)); k < parts.size(); k += size_t(stride)) {
    const glm::vec3 towards = -parts[k].direction;
    const float cosine = glm::dot(towards, side.normal);
    if (cosine <= 0.0f) continue;
    const std::uint32_t seed = std::uint32_t(s) * 2654435769u + std::uint32_t(sample) * 2246822519u + std::uint32_t(k);
    sum += cosine * parts[k].irradiance *
           embree.passed({start.origin, towards, std::numeric_limits<float>::infinity(), seed, start.from, {}});
  }
  return sum * float(stride);
}

}  // namespace

const std::vector<glm::vec4>& SideSkyCpu::irradiance(const VoxelGrid& voxels, const EmbreeScene& embree,
                                                     std::span<const SkyLight> parts, int version, int sample) {
  const size_t count = voxels.side_count();
  const bool same = version == version_ && sample == sample_ && count == sides_.size() &&
                    std::memcmp(sides_.data(), voxels.sides().data(), count * sizeof(shared::Side)) == 0;
  if (same) return irradiance_;
  version_ = version;
  sample_ = sample;
  sides_.assign(voxels.sides().begin(), voxels.sides().end());
  irradiance_.resize(count);
  const int stride = std::max(int(parts.size()) / kRays, 1);
  tbb::parallel_for(size_t(0), count, [&](size_t s) {
    irradiance_[s] = glm::vec4(irradiance_of(voxels, embree, s, parts, stride, sample), 0.0f);
  });
  return irradiance_;
}

// E is that of the surface's plane, so A is the side's own area, however it is tilted (docs/theory.md#light-in).
void add_sky(const VoxelGrid& voxels, std::span<const glm::vec4> irradiance, bool apart, SideFlux& flux) {
  assert(irradiance.size() == voxels.side_count());
  std::vector<glm::vec4>& into = apart ? flux.emitted : flux.punctual;
  for (size_t s = 0; s < irradiance.size(); ++s) {
    const shared::Side& side = voxels.sides()[s];
    into[s] += glm::vec4(glm::vec3(irradiance[s]) * side.albedo * side.area_m2, 0.0f);
  }
  if (apart) flux.emits = true;
}

}  // namespace volgi
