#include "propagation/light_in/gather_steadied.h"

#include <algorithm>

#include "core/level.h"
#include "propagation/reachable_cells_internal.h"
#include "propagation/side_loops.h"

namespace volgi {
namespace {

constexpr int FIRST_SHIFT = 2, LAST_SHIFT = 5;  // regions of 4^3 ... 32^3 cells
constexpr float VOLUME_ERROR = 0.05f;           // of its distribution, relative

float square(float x) { return x * x; }

/// Sums over sides, by area.
struct Sums {
  glm::vec3 rays_E{0.0f}, volume_E{0.0f};
  float area = 0.0f, scatter = 0.0f, degrees = 0.0f, rays = 0.0f;

  void add(const Sums& s, float weight) {
    rays_E += weight * s.rays_E;
    volume_E += weight * s.volume_E;
    area += weight * s.area;
    scatter += weight * s.scatter;
    degrees += weight * s.degrees;
    rays += weight * s.rays;
  }
  /// Of one ray over the mean, squared.
  float relative_variance() const {
    const float mean = level(rays_E) / std::max(area, 1e-30f);
    if (!(degrees > 0.0f) || !(mean > 0.0f)) return 0.0f;
    return scatter / degrees / (mean * mean);
  }
};

Sums sums_of(const shared::Side& side, const Gathered& g, glm::vec3 volume) {
  if (g.rays == 0) return {};
  return {side.area_m2 * g.mean(), side.area_m2 * volume, side.area_m2, g.scatter(), float(g.rays - 1), float(g.rays)};
}

/// Regions of one size: cells of 2^shift along an edge, six ways to look.
class Regions {
 public:
  Regions(const Grid& grid, int shift) : shift_(shift), size_(((grid.cells - 1) >> shift) + 1) {
    sums_.resize(6 * size_t(size_.x) * size_t(size_.y) * size_t(size_.z));
  }
  void add(glm::ivec3 cell, int face, const Sums& s) { sums_[index(cell >> shift_, face)].add(s, 1.0f); }
  void add(const Regions& finer) {
    for (int z = 0; z < finer.size_.z; ++z) {
      for (int y = 0; y < finer.size_.y; ++y) {
        for (int x = 0; x < finer.size_.x; ++x) {
          for (int face = 0; face < 6; ++face)
            sums_[index(glm::ivec3(x, y, z) >> 1, face)].add(finer.sums_[finer.index({x, y, z}, face)], 1.0f);
        }
      }
    }
  }
  /// Trilinear between regions.
  Sums at(glm::ivec3 cell, int face) const {
    const glm::vec3 point = (glm::vec3(cell) + 0.5f) / float(1 << shift_) - 0.5f;
    const glm::vec3 low = glm::floor(point), t = point - low;
    Sums sums;
    for (int k = 0; k < 8; ++k) {
      const glm::ivec3 d(k & 1, k >> 1 & 1, k >> 2);
      const glm::ivec3 at = glm::ivec3(low) + d;
      if (glm::any(glm::lessThan(at, glm::ivec3(0))) || glm::any(glm::greaterThanEqual(at, size_))) continue;
      const glm::vec3 w = glm::mix(1.0f - t, t, glm::vec3(d));
      sums.add(sums_[index(at, face)], w.x * w.y * w.z);
    }
    return sums;
  }

 private:
  size_t index(glm::ivec3 at, int face) const {
    return size_t(face) + 6 * (size_t(at.x) + size_t(size_.x) * (size_t(at.y) + size_t(size_.y) * size_t(at.z)));
  }
  int shift_;
  glm::ivec3 size_;
  std::vector<Sums> sums_;
};

float trust(float relative_variance) { return square(VOLUME_ERROR) / (square(VOLUME_ERROR) + relative_variance); }

class Steadier {
 public:
  Steadier(const VoxelGrid& voxels, std::span<const Gathered> gathered, std::span<const glm::vec4> irradiance)
      : voxels_(voxels), gathered_(gathered), irradiance_(irradiance) {
    for (int shift = FIRST_SHIFT; shift <= LAST_SHIFT; ++shift) regions_.emplace_back(voxels.grid(), shift);
    for (size_t s = 0; s < gathered.size(); ++s) {
      const shared::Side& side = voxels.sides()[s];
      regions_[0].add(shared::cell_coord(voxels.grid(), side.cell), side.face, of(s));
    }
    for (size_t k = 1; k < regions_.size(); ++k) regions_[k].add(regions_[k - 1]);
  }

  glm::vec3 at(size_t i) const {
    const shared::Side& side = voxels_.sides()[i];
    const glm::ivec3 cell = shared::cell_coord(voxels_.grid(), side.cell);
    const glm::vec3 volume(irradiance_[i]);
    const Sums near = around(i);
    if (!(near.area > 0.0f)) return volume;
    const Sums wide = regions_[0].at(cell, side.face);
    const float own = trust(wide.relative_variance() / near.rays);
    const glm::vec3 rays = near.rays_E / near.area;
    if (own > 0.99f) return rays;
    return own * rays + (1.0f - own) * spread(cell, side.face, volume, wide);
  }

 private:
  Sums of(size_t s) const { return sums_of(voxels_.sides()[s], gathered_[s], glm::vec3(irradiance_[s])); }

  Sums around(size_t i) const {
    Sums sums;
    for_sides_alike(voxels_, i, [&](size_t s) { sums.add(of(s), 1.0f); });
    return sums;
  }

  /// The volume's, as bright as rays say.
  glm::vec3 spread(glm::ivec3 cell, int face, glm::vec3 volume, const Sums& first) const {
    glm::vec3 sum(0.0f);
    float left = 1.0f;
    for (size_t k = 0; k < regions_.size() && left > 0.01f; ++k) {
      const Sums s = k == 0 ? first : regions_[k].at(cell, face);
      const bool last = k + 1 == regions_.size();
      const float w = last ? left : left * trust(s.relative_variance() / std::max(s.rays, 1.0f));
      sum += w * volume * ratio(s);
      left -= w;
    }
    return sum + left * volume;
  }
  static glm::vec3 ratio(const Sums& s) {
    constexpr float FAR = 4.0f;  // nobody errs by more; where little light is, ratios are noise
    return glm::clamp(s.rays_E / glm::max(s.volume_E, 1e-30f), 1.0f / FAR, FAR);
  }

  const VoxelGrid& voxels_;
  std::span<const Gathered> gathered_;
  std::span<const glm::vec4> irradiance_;
  std::vector<Regions> regions_;
};

}  // namespace

std::vector<glm::vec4> steadied(const VoxelGrid& voxels, std::span<const Gathered> gathered,
                                std::span<const glm::vec4> irradiance) {
  std::vector<glm::vec4> result(irradiance.begin(), irradiance.end());
  const Steadier steadier(voxels, gathered, irradiance);
  for_each_side(gathered.size(), [&](size_t i) {
    if (gathered[i].rays > 0) result[i] = glm::vec4(steadier.at(i), 1.0f);
  });
  return result;
}

}  // namespace volgi
