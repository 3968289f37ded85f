#pragma once
#include <vector>

#include "core/gl/objects.h"
#include "core/gl/pass_timer.h"
#include "core/gl/program.h"
#include "screen/lights/rsm/virtual_lights.h"
#include "shaders/screen/visibility/area_maps/virtual_area_light.shared.h"

namespace volgi::screen {

struct VirtualAreaLightOptions {
  int count = 64;                // M, up to MAX_VIRTUAL_AREA_LIGHTS
  float position_weight = 0.7f;  // w_x, of the distance over the scene's diagonal
  float normal_weight = 0.3f;    // w_alpha, of the angle over pi
  // Ours, of the distance off the cluster's plane over the scene's diagonal; 0 is as printed. Without it both sides of
  // a body come together, the inside of its far wall and the outside of its near one, and are seen from one of them.
  float plane_weight = 2.0f;
  enum class Position {
    nearest,  // of the cluster's light that is nearest to the mean of all
    mean,     // as printed (§5): may lie inside what the lights lie on
  } position = Position::nearest;
};

/// Pass "screen/visibility/area_maps/virtual_area_lights": k-means of all virtual lights (reflected and emitted) into
/// area lights, restarted every frame from light k N / M, or the next that has flux and is free (Dong et al. 2009, §5
/// and §6). Deterministic: sums have a fixed order. Lights without flux belong to no cluster; none is left empty at the
/// start while there are lights with flux. A cluster's position is that of its light nearest to their mean, or the
/// mean itself. Rectangles lie along the world's X as seen on their plane, within 45 degrees of X along its Y
/// (shaders/screen/visibility/area_maps/virtual_area_lights_shape.comp.glsl). Cost: lights times clusters, a few times
/// over.
class VirtualAreaLights {
 public:
  static constexpr const char* name = "screen/visibility/area_maps/virtual_area_lights";
  /// Assignments; when no light changes its cluster the rest cost nothing. Measured on spots and points in a box: the
  /// end takes 8 (256 lights into 30) to 62 (4096 into 256) on average, 87 at most. After 8, 1024 lights in 30 clusters
  /// have a sum of distances 2 % above the end's (after 4: 5 %, 16: 0.6 %; 4096 in 256 at worst 11 %), and as a spot
  /// turns the centers move 1.8 times as far as lights do (2.5 at the end): more would carry small changes far.
  static constexpr int kMaxIterations = 8;

  /// @throws Error(usage) when the count does not lie between 1 and MAX_VIRTUAL_AREA_LIGHTS, or a weight is negative
  /// or not finite.
  explicit VirtualAreaLights(const VirtualAreaLightOptions& options);

  void run(const VirtualLights& lights, float scene_diagonal_m, gl::PassTimer& timer);
  /// @param lights  shared::VirtualLight, at least `count`. @param sample  FrameData::sample: of all but the first a
  /// cluster's position is that of any of its lights, so that means see what all of them see.
  void run(const gl::Buffer& lights, int count, float scene_diagonal_m, gl::PassTimer& timer, int sample = 0);

  int count() const { return options_.count; }
  const gl::Buffer& buffer() const { return area_lights_; }     // shared::VirtualAreaLight x MAX_VIRTUAL_AREA_LIGHTS
  const gl::Buffer& cluster_of() const { return cluster_of_; }  // C(i): uint for each virtual light
  const gl::Buffer& order() const { return order_; }  // uint: virtual lights by cluster; those without flux last
  /// All three wait for the GPU; after a frame, not in one.
  std::vector<shared::VirtualAreaLight> download() const;
  int alive() const;       // clusters with lights
  int iterations() const;  // that changed a cluster
  size_t bytes() const;

 private:
  VirtualAreaLightOptions options_;
  gl::Buffer area_lights_, cluster_of_, order_;
  gl::Buffer centers_;   // position and normal, vec4 each
  gl::Buffer progress_;  // virtual_area_lights.glsl
  gl::Program seed_, assign_, update_, list_, shape_;
};

}  // namespace volgi::screen
