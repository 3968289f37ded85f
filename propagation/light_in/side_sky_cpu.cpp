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

namespace {

bool same_sides(const VolumeSides& sides, const std::vector<shared::Side>& known) {
  if (known.size() != sides.count()) return false;
  for (size_t level = 0; level < sides.levels(); ++level) {
    const VoxelGrid& voxels = sides.level(level);
    if (std::memcmp(known.data() + sides.first(level), voxels.sides().data(),
                    voxels.side_count() * sizeof(shared::Side)) != 0)
      return false;
  }
  return true;
}

}  // namespace

const std::vector<glm::vec4>& SideSkyCpu::irradiance(const VolumeSides& sides, const EmbreeScene& embree,
                                                     std::span<const SkyLight> parts, int version, int sample) {
  if (version == version_ && sample == sample_ && same_sides(sides, sides_)) return irradiance_;
  version_ = version;
  sample_ = sample;
  sides_.clear();
  irradiance_.resize(sides.count());
  const int stride = std::max(int(parts.size()) / kRays, 1);
  for (size_t level = 0; level < sides.levels(); ++level) {
    const VoxelGrid& voxels = sides.level(level);
    const size_t first = sides.first(level), count = voxels.side_count();
    sides_.insert(sides_.end(), voxels.sides().begin(), voxels.sides().begin() + std::ptrdiff_t(count));
    tbb::parallel_for(size_t(0), count, [&](size_t s) {
      irradiance_[first + s] = glm::vec4(irradiance_of(voxels, embree, s, parts, stride, sample), 0.0f);
    });
  }
  return irradiance_;
}

// E is that of the surface's plane, so A is the side's own area, however it is tilted (docs/theory.md#light-in).
void add_sky(const VolumeSides& sides, std::span<const glm::vec4> irradiance, bool apart, SideFlux& flux) {
  assert(irradiance.size() == sides.count());
  std::vector<glm::vec4>& into = apart ? flux.emitted : flux.punctual;
  for (size_t s = 0; s < irradiance.size(); ++s) {
    const shared::Side& side = sides[s];
    into[s] += glm::vec4(glm::vec3(irradiance[s]) * side.albedo * side.area_m2, 0.0f);
  }
  if (apart) flux.emits = true;
}

}  // namespace volgi
