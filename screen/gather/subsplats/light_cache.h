#pragma once
#include "core/gl/objects.h"
#include "core/gl/pass_timer.h"
#include "core/gl/program.h"
#include "core/gl/scan.h"
#include "screen/base/virtual_light_list_gl.h"
#include "screen/visibility/area_maps/virtual_area_lights.h"

namespace volgi::screen {

/// Pass "screen/gather/subsplats/light_cache": the virtual lights that have light, one behind the other for gathers to
/// read (Nichols 2010, §4.2.1.2), in their order or in that of clusters. Their number stays on the GPU.
class LightCache {
 public:
  static constexpr const char* name = "screen/gather/subsplats/light_cache";
  LightCache();

  /// @param clusters  in whose order; their lights' `source` is the cluster. Null: in their own.
  void run(const VirtualLightListGl& lights, const VirtualAreaLights* clusters, gl::PassTimer& timer);

  int blocks() const;  // of VIRTUAL_LIGHTS_PER_BLOCK, that may have lights
  void bind_block(int block) const;
  int most_lights() const { return most_; }  // that there is room for; those behind the last have no flux
  const gl::Buffer& size() const { return size_; }
  const gl::Buffer& lights() const { return cached_; }
  size_t bytes() const { return cached_.bytes() + starts_.bytes() + size_.bytes() + scan_.bytes(); }

 private:
  int most_ = 0;
  gl::Buffer cached_, starts_, size_;
  gl::Scan scan_;
  gl::Program count_, copy_, copy_clustered_;
};

}  // namespace volgi::screen
