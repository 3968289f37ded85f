#pragma once
#include "core/gl/pass_timer.h"
#include "core/gl/program.h"
#include "propagation/side_flux_gl.h"
#include "screen/base/smooth_pixels.h"
#include "screen/base/virtual_light_list_gl.h"
#include "screen/lights/resample/virtual_light_subdivision.h"
#include "screen/sources/sky/sky_maps.h"

namespace volgi::screen {

/// The first bounce as the screen carries it: virtual lights.
struct FirstBounce {
  const VirtualLightListGl& lights;
  const VirtualLightSubdivision* subdivision;  // whose fine sub-lights send their light; null: the lights do
  const SkyMaps* sky;                    // whose arrival the screen carries, but not its first reflection; or null
  int sample = 0;                        // FrameData::sample
  const SmoothGather* smooth = nullptr;  // what pixels are gathered together with; null: the volume's light alone
};

/// Pass "screen/bounces/volume/reflected_flux": what sides reflect of the virtual lights, the source of bounces 2 ... n
/// of punctual light and 1 ... n of emission (docs/theory.md#composition). Lights send rays by their cosine, which end
/// on the first side that they meet from its front: in a cell, on its plane; at a face, on any that is blocked there,
/// so that nothing passes a surface, however thin. Twin: propagation/light_in/reflected_flux_cpu.h, with rays that meet
/// triangles, and as many to each light as its power asks for; here all lights have the same number, as sums would have
/// to come before. Cost: kRays rays through the cells.
class ReflectedFluxGl {
 public:
  static constexpr const char* name = "screen/bounces/volume/reflected_flux";
  static constexpr int kRays = 1 << 17;  // at least one a sender
  explicit ReflectedFluxGl(const Scene& scene);
  /// The scene has changed: its light may be more. Looks at emissive textures, so not once a frame.
  void follow(const Scene& scene);
  /// @param flux  begun for these voxels; reflected lights end in punctual(), emitted ones in emitted().
  void run(const VoxelGridGl& voxels, const FirstBounce& first_bounce, SideFluxGl& flux, gl::PassTimer& timer);

 private:
  gl::Program program_;
  float reflected_power_ = 0.0f, emitted_power_ = 0.0f;  // no light brings more [W]
};

}  // namespace volgi::screen
