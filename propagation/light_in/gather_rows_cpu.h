#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "core/visibility/embree_scene.h"
#include "propagation/light_in/passage_aim.h"
#include "voxel/voxel_grid.h"

namespace volgi {

/// Which sides the rays of a side meet, between triangles: rows of form factors by sampling. A row holds as long as
/// geometry stands still, whatever the light. Where there are narrow passages, a row has a quarter more rays, through
/// those (passage_aim.h). Memory: 8 bytes a ray, 12 of those through passages. Cost: a ray of Embree's and a search for
/// the side of what it meets, some 0.5 us together.
class GatherRows {
 public:
  /// What a ray has met.
  struct Met {
    static constexpr std::int32_t NOTHING = -1;  // the outside: no light comes from there
    static constexpr std::int32_t UNKNOWN = -2;  // a surface that no side stands for
    std::int32_t side = NOTHING;
    std::uint32_t tint = 0xffffff;  // of glass on the way, 8 bits for red, green, blue from the lowest on
  };

  /// What a ray through a passage has met.
  struct Through {
    Met met;
    float weight = 0.0f;  // of its radiosity in the irradiance, over the mean of a row's
  };
  struct Row {
    std::span<const Met> met;
    std::span<const Through> through;
  };

  /// Rays first ... first + count - 1 of each of some sides, by the cosine about the side's normal from the middle of
  /// its surface (start_of_side()); a side's rays are points of an additive recurrence that begins elsewhere for each.
  void trace(const VoxelGrid& voxels, const EmbreeScene& embree, const PassageAim& passages,
             std::span<const std::uint32_t> sides, int first, int count);

  int rays() const { return rays_; }  // of a row, but for those through passages
  size_t rows() const { return rays_ == 0 ? 0 : met_.size() / size_t(rays_); }
  Row row(size_t i) const {
    return {{met_.data() + i * size_t(rays_), size_t(rays_)},
            {through_.data() + i * size_t(rays_through_), size_t(rays_through_)}};
  }
  size_t traced() const { return met_.size() + through_.size(); }
  size_t bytes() const { return met_.capacity() * sizeof(Met) + through_.capacity() * sizeof(Through); }
  /// What bytes() comes to at most for so many rays by the cosine.
  static size_t most_bytes(size_t sides, int count) {
    return sides * (size_t(count) * sizeof(Met) + size_t(through_of(count)) * sizeof(Through));
  }

 private:
  static int through_of(int count) { return (count + 3) / 4; }

  int rays_ = 0, rays_through_ = 0;
  std::vector<Met> met_;
  std::vector<Through> through_;
};

/// Sums over what rays bring; means by what is known of them.
struct Gathered {
  glm::vec3 sum{0.0f}, sum_through{0.0f};        // the latter: of rays through passages
  float squares = 0.0f, squares_through = 0.0f;  // of the mean over red, green, blue
  int rays = 0, rays_through = 0;

  /// @param radiosity  by side [W m^-2].
  void add(const GatherRows::Row& row, std::span<const glm::vec3> radiosity);
  glm::vec3 mean() const {
    const glm::vec3 through = rays_through > 0 ? sum_through / float(rays_through) : glm::vec3(0.0f);
    return rays > 0 ? sum / float(rays) + through : glm::vec3(0.0f);
  }
  /// Squared differences from the mean, summed; over rays - 1 it is the variance of one ray, which has its part of what
  /// rays through passages err by.
  float scatter() const;
};

}  // namespace volgi
