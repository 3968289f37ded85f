#pragma once
#include <array>
#include <optional>

#include "core/gl/objects.h"
#include "core/gl/pass_timer.h"
#include "core/gl/program.h"
#include "core/occluder_points.h"

namespace volgi::screen {

struct ImperfectMapOptions {
  int texels = 32;                      // on a side of a map: 16, 32 or 64
  int points_log2 = 13;                 // of each map: 2^13 are all that a splat's key can tell apart
  int pull_levels = 3;                  // coarser levels from which holes are closed
  int regular_count = 256;              // of lights that get a map where maps are regular
  int regular_texels = 128;             // on a side of such a map
  static constexpr int kPoolLog2 = 16;  // of all points
  static constexpr int kMaxPointsLog2 = 13;
};

/// Pass "screen/visibility/imperfect/imperfect_maps": depth maps of many views at once, each splatted from a run of its
/// own of points on the scene's surfaces, holes closed by pull-push (Ritschel et al. 2008, "Imperfect Shadow Maps",
/// sections 4.1 to 4.3). We depart: a texel keeps the nearest point, not its depth, and takes the distance of that
/// point's plane along its own ray, so that surfaces do not hide themselves; holes take the nearest point of the
/// coarser level instead of a mean; a group has its map in shared memory, so that all maps are one dispatch.
/// Deterministic. Cost: views times points of a view.
class ImperfectMaps {
 public:
  static constexpr const char* name = "screen/visibility/imperfect/imperfect_maps";
  /// @throws Error(usage) for texels that are not 16, 32 or 64.
  ImperfectMaps(const Scene& scene, const ImperfectMapOptions& options);

  /// The scene has moved: its points are placed anew.
  void follow(const Scene& scene);
  /// @param views  shared::VirtualAreaLight x `count`: position, normal, right; light_count 0 sees nothing.
  /// @param distances  R32F array of layers of `tiles` x `tiles` maps, as ParaboloidDepthMaps::distance().
  void run(const gl::Buffer& views, int count, const gl::Texture& distances, int tiles, float scene_diagonal_m,
           gl::PassTimer& timer) const;
  int texels() const { return options_.texels; }
  size_t bytes() const { return points_gl_.bytes(); }

 private:
  void upload();
  ImperfectMapOptions options_;
  OccluderPoints points_;
  gl::Buffer points_gl_;
  gl::Program program_;
};

}  // namespace volgi::screen
