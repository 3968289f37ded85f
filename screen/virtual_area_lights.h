#pragma once
#include <vector>

#include "core/gl/objects.h"
#include "core/gl/pass_timer.h"
#include "core/gl/program.h"
#include "screen/virtual_lights.h"
#include "shaders/shared/virtual_area_light.shared.h"

namespace volgi::screen {

struct VirtualAreaLightOptions {
  int count = 30;                // M, up to VIRTUAL_AREA_LIGHTS_MOST
  float position_weight = 0.7f;  // w_x, of the distance over the scene's diagonal
  float normal_weight = 0.3f;    // w_alpha, of the angle over pi
};

/// Pass "screen/virtual_area_lights": k-means of all virtual lights (reflected and emitted) into area lights, restarted
/// every frame from light k N / M (Dong et al. 2009, §5 and §6). Deterministic: sums have a fixed order. Lights without
/// flux belong to no cluster. Cost: lights times clusters, a few times over.
class VirtualAreaLights {
 public:
  static constexpr const char* name = "screen/virtual_area_lights";
  explicit VirtualAreaLights(const VirtualAreaLightOptions& options);

  void run(const VirtualLights& lights, float scene_diagonal_m, gl::PassTimer& timer);

  int count() const { return options_.count; }
  const gl::Buffer& buffer() const { return area_lights_; }     // shared::VirtualAreaLight x VIRTUAL_AREA_LIGHTS_MOST
  const gl::Buffer& cluster_of() const { return cluster_of_; }  // C(i): uint for each virtual light
  const gl::Buffer& order() const { return order_; }  // uint: virtual lights by cluster; those without flux last
  /// Both wait for the GPU; after a frame, not in one.
  std::vector<shared::VirtualAreaLight> download() const;
  int alive() const;  // clusters with lights
  size_t bytes() const;

 private:
  VirtualAreaLightOptions options_;
  gl::Buffer area_lights_, cluster_of_, order_;
};

}  // namespace volgi::screen
