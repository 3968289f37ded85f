#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "core/visibility/embree_scene.h"
#include "voxel/voxel_grid.h"

namespace volgi {

/// Which sides the rays of a side meet, between triangles: rows of form factors by sampling. A row holds as long as
/// geometry stands still, whatever the light. Memory: 8 bytes a ray. Cost: a ray of Embree's and a search for the side
/// of what it meets, some 0.5 us together.
class GatherRows {
 public:
  /// What a ray has met.
  struct Met {
    static constexpr std::int32_t NOTHING = -1;  // the outside: no light comes from there
    static constexpr std::int32_t UNKNOWN = -2;  // a surface that no side stands for
    std::int32_t side = NOTHING;
    std::uint32_t tint = 0xffffff;  // of glass on the way, 8 bits for red, green, blue from the lowest on
  };

  /// Rays first ... first + count - 1 of each of some sides, by the cosine about the side's normal from the middle of
  /// its surface (start_of_side()); a side's rays are points of an additive recurrence that begins elsewhere for each.
  void trace(const VoxelGrid& voxels, const EmbreeScene& embree, std::span<const std::uint32_t> sides, int first,
             int count);

  int rays() const { return rays_; }  // of a row
  size_t rows() const { return rays_ == 0 ? 0 : met_.size() / size_t(rays_); }
  std::span<const Met> row(size_t i) const { return {met_.data() + i * size_t(rays_), size_t(rays_)}; }
  size_t bytes() const { return met_.capacity() * sizeof(Met); }

 private:
  int rays_ = 0;
  std::vector<Met> met_;
};

/// Sums over what rays bring; means by what is known of them.
struct Gathered {
  glm::vec3 sum{0.0f};
  float squares = 0.0f;  // of the mean over red, green, blue
  int rays = 0;

  /// @param radiosity  by side [W m^-2].
  void add(std::span<const GatherRows::Met> row, std::span<const glm::vec3> radiosity);
  glm::vec3 mean() const { return rays > 0 ? sum / float(rays) : glm::vec3(0.0f); }
  /// Squared differences from the mean, summed; over rays - 1 it is the variance of one ray.
  float scatter() const;
};

}  // namespace volgi
