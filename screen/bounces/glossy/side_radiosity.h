#pragma once
#include <optional>

#include "core/gl/objects.h"
#include "core/gl/pass_timer.h"
#include "core/gl/program.h"
#include "screen/base/reflective_shadow_map.h"
#include "screen/bounces/volume/frame_volume.h"

namespace volgi::screen {

/// Pass "screen/bounces/glossy/side_radiosity": what every side of the volume sends of light that comes from elsewhere:
/// of the first bounce and of all after it, as the volume has them, and of punctual lights with their shadow maps. What
/// it emits itself is in the side. Cost: one look at each side, and four at each light's map.
class SideRadiosity {
 public:
  static constexpr const char* name = "screen/bounces/glossy/side_radiosity";
  SideRadiosity();
  /// @param volume  of the first bounce on the screen (VolumeOptions::Source::first_bounce), after its run.
  /// @param bounces  VolumeOptions::bounces of it: light that has been reflected as often, by the side the last time.
  void run(const FrameVolume& volume, const ReflectiveShadowMap& maps, std::optional<int> bounces,
           gl::PassTimer& timer);

  const gl::Buffer& radiosity() const { return radiosity_; }  // vec4 a side [W m^-2]
  size_t bytes() const { return radiosity_.bytes(); }

 private:
  gl::Buffer radiosity_;
  gl::Program program_, punctual_;
};

}  // namespace volgi::screen
