#pragma once
#include "core/gl/pass_timer.h"
#include "core/gl/program.h"
#include "propagation/side_flux_gl.h"
#include "screen/base/reflective_shadow_map.h"

namespace volgi::screen {

/// Pass "screen/bounces/volume/inject_reflective_shadow_map": the light that every texel of the reflective shadow maps
/// reflects becomes flux of the sides behind it. The sum over sides is the sum over texels: a texel's power times its
/// albedo, so that small or oblique lit patches lose nothing. Cost: one look for a side per lit texel.
class InjectReflectiveShadowMap {
 public:
  static constexpr const char* name = "screen/bounces/volume/inject_reflective_shadow_map";
  InjectReflectiveShadowMap();
  void run(const VoxelGridGl& voxels, const ReflectiveShadowMap& maps, const Scene& scene, SideFluxGl& flux,
           gl::PassTimer& timer);

 private:
  gl::Program program_;
};

}  // namespace volgi::screen
