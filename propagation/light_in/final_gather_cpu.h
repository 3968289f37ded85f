#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "core/light.h"
#include "core/visibility/embree_scene.h"
#include "propagation/bounces_cpu.h"
#include "propagation/light_in/gather_rows_cpu.h"
#include "voxel/voxel_grid.h"

namespace volgi {

/// Bounces once more between triangles: radiosity by rays, B = B_0 + albedo E with E the mean of B over what a side's
/// rays meet, which starts from the volume's answer. Cells are staircases where surfaces are tilted, and shut or wide
/// open where gaps are narrow; rays are not. Few rays of every side say where light goes, since what comes round is a
/// mean over thousands of them; more rays of those that pixels read make the picture, whose noise
/// light_in/gather_steadied.h takes away (docs/theory.md#final-gather). No result depends on the number of threads.
///
/// Rays are traced once for a scene that stands still, whatever the light; of other pixels, theirs anew. Cost: some
/// 0.5 us a ray, at most MOST_RAYS of either kind, and an iteration 3 ns for each ray of all sides. Memory: 8 bytes a
/// ray, some 130 bytes a side. What passes narrow passages has rays of its own (light_in/passage_aim.h), a quarter
/// more.
class FinalGatherCpu {
 public:
  static constexpr size_t MOST_CELLS = size_t(1) << 23;
  static constexpr size_t MOST_RAYS = size_t(1) << 21;
  static constexpr int RAYS_OF_ALL = 16;   // of each side, at most
  static constexpr int RAYS_BESIDE = 64;   // more of those in passages: few, and all light passes by them
  static constexpr int RAYS_OF_SEEN = 64;  // of each that pixels read, by default

  struct Report {
    size_t seen_sides = 0, rays = 0;
    int iterations = 0;
  };

  /// Flux A B_0 by side [W].
  struct Sent {
    std::vector<glm::vec3> reflected;  // of light that no side had before
    std::vector<glm::vec3> emitted;    // whose arrival is not wanted, only what sides return of it; empty: none
  };
  /// @param passages  of `voxels`, numbered. @param volume  irradiance of sides but for the arrival of what is emitted.
  /// @param seen    by cell: whether its sides are wanted (cells_seen()).
  /// @param rays    of each of these.
  /// @return in place of `volume`: of the others as it is there.
  const std::vector<glm::vec4>& run(const VoxelGrid& voxels, const EmbreeScene& embree,
                                    std::span<const PassageFace> passages, const Sent& sent,
                                    std::span<const glm::vec4> volume, const std::vector<bool>& seen, int rays);
  /// Of the last run(), by side: what it sends of Sent::reflected and what comes round [W m^-2].
  std::span<const glm::vec3> radiosity() const { return radiosity_; }

  /// What sides that pixels read receive from what is near, by their rays, with lamps' light on it [W m^-2, mean over
  /// red, green, blue]: where it is much, cells are too coarse (light_in/contact_light_cpu.h).
  struct Near {
    std::vector<float> irradiance;    // by side; 0 of the others
    std::vector<glm::vec3> from_far;  // by side: what the rest of the rays bring, with what is emitted there
    float mean = 0.0f;                // of all that is not emitted, by area
  };
  /// Of the last run(). Cost: with lamps, a shadow ray for each side when the scene or its lamps have changed.
  Near near_light(const VoxelGrid& voxels, const EmbreeScene& embree);

  const Report& report() const { return report_; }
  size_t bytes() const;
  /// What bytes() comes to at most.
  static size_t bytes_for(const Grid& grid, size_t sides, int rays);

 private:
  void follow(const VoxelGrid& voxels, const EmbreeScene& embree, std::span<const PassageFace> passages,
              const std::vector<bool>& seen, int rays);
  void follow_passages(const VoxelGrid& voxels, const EmbreeScene& embree, const PassageAim& passages);
  std::vector<glm::vec3> radiosity_of(const VoxelGrid& voxels, const Sent& sent) const;
  Gathered gathered(size_t side, std::span<const glm::vec3> radiosity) const;
  void iterate(const VoxelGrid& voxels, std::span<const glm::vec3> own);
  void light_by_lamps(const VoxelGrid& voxels, const EmbreeScene& embree);

  std::vector<shared::Side> sides_;  // that rows are of
  std::vector<bool> seen_;
  int rays_of_seen_ = 0;
  std::vector<std::uint32_t> seen_sides_;
  std::vector<std::uint32_t> beside_;     // sides in passages and next to them, ascending
  std::vector<std::int32_t> row_beside_;  // by side: its place there, or -1
  GatherRows all_, more_, of_beside_;     // more_: of seen_sides_
  std::vector<glm::vec3> radiosity_, received_;
  std::vector<shared::PunctualLight> lamps_;  // that lit_ is of
  std::vector<glm::vec3> lit_;                // by side: radiosity by lamps alone; empty: not known
  std::vector<glm::vec4> irradiance_;
  Report report_;
};

/// Cells whose sides a picture may read at these points of surfaces (propagation/pixel_irradiance_cpu.h), and those
/// that their means are over. @param positions  world; where w is 0 there is none.
std::vector<bool> cells_seen(const Grid& grid, std::span<const glm::vec4> positions);

}  // namespace volgi
