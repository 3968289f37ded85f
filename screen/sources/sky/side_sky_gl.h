#pragma once
#include "core/gl/pass_timer.h"
#include "core/gl/program.h"
#include "propagation/side_flux_gl.h"
#include "screen/sources/sky/sky_maps.h"
#include "voxel/voxel_grid_gl.h"

namespace volgi::screen {

/// Pass "screen/sources/sky/side_sky": what a volume's sides reflect of light straight from the sky, as far as the
/// sky's maps let it through; each side looks at some of the parts. Twin: propagation/light_in/side_sky_cpu.h. Cost: 64
/// looks into maps a side.
class SideSkyGl {
 public:
  static constexpr const char* name = "screen/sources/sky/side_sky";
  SideSkyGl();
  /// @param flux  of these voxels; added to emitted(). @param sample  FrameData::sample: sides look at other parts.
  void run(const VoxelGridGl& voxels, const SkyMaps& maps, const SideFluxGl& flux, gl::PassTimer& timer,
           int sample = 0);

 private:
  gl::Program program_;
};

}  // namespace volgi::screen
