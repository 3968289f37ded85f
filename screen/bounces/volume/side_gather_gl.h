#pragma once
#include "core/gl/pass_timer.h"
#include "core/gl/program.h"
#include "propagation/side_flux_gl.h"
#include "screen/base/smooth_pixels.h"
#include "screen/base/virtual_light_list_gl.h"
#include "screen/lights/resample/virtual_light_subdivision.h"
#include "screen/sources/sky/sky_maps.h"
#include "screen/visibility/area_maps/light_clusters.h"

namespace volgi::screen {

/// The first bounce as the screen carries it: virtual lights, and how much of them is seen.
struct FirstBounce {
  const VirtualLightListGl& lights;
  const LightClusters& clusters;
  const VirtualLightSubdivision* subdivision;  // what lights those near it instead; null: nobody
  float near_zone;                             // areas of a light; 0 without subdivision
  const SkyMaps* sky;                    // whose arrival the screen carries, but not its first reflection; or null
  int sample = 0;                        // FrameData::sample
  const SmoothGather* smooth = nullptr;  // what pixels are gathered together with; null: the volume's light alone
};

/// Pass "screen/bounces/volume/side_gather": what sides reflect of the virtual lights, each seen as far as its area
/// light is: the source of bounces 2 ... n of punctual light and 1 ... n of emission (docs/theory.md#composition).
/// Twin: propagation/light_in/side_gather_cpu.h, with rays. Cost: every light, and every area light's shadow, at every
/// side.
class SideGatherGl {
 public:
  static constexpr const char* name = "screen/bounces/volume/side_gather";
  explicit SideGatherGl(const AreaLightShadow& shadow);
  /// @param flux  begun for these voxels; reflected lights end in punctual(), emitted ones in emitted().
  void run(const VoxelGridGl& voxels, const FirstBounce& first_bounce, const SideFluxGl& flux, gl::PassTimer& timer);

 private:
  gl::Program program_;
};

}  // namespace volgi::screen
