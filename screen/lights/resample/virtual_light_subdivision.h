#pragma once
#include "core/gl/objects.h"
#include "core/gl/pass_timer.h"
#include "core/gl/program.h"
#include "screen/base/reflective_shadow_map.h"
#include "screen/lights/resample/resample_virtual_lights.h"
#include "screen/lights/rsm/virtual_lights.h"

namespace volgi::screen {

/// Pass "screen/lights/resample/virtual_light_subdivision": subdivides what each resampled virtual light stands for,
/// its range of Hilbert's curve through what its source sends: FINE_SUBLIGHTS new samples of the reflective shadow map
/// at equal steps, and COARSE_SUBLIGHTS, the sums of four fine ones each. What is near a light is lit by these
/// (NearLights). Sub-lights of emitters, and of lights that are sampled by flux, are the candidates in their range.
/// Cost: as VirtualLights with so many lights.
class VirtualLightSubdivision {
 public:
  static constexpr const char* name = "screen/lights/resample/virtual_light_subdivision";
  static constexpr const char* product_name = "sub-lights of virtual lights";
  VirtualLightSubdivision();

  /// @param chosen  of `candidates`. @param sample  FrameData::sample.
  void run(const ReflectiveShadowMap& maps, const VirtualLights& candidates, const ResampleVirtualLights& chosen,
           gl::PassTimer& timer, int sample = 0);

  const gl::Buffer& sublights() const { return sublights_; }  // shared::SubLight, SUBLIGHTS_PER_LIGHT for each light
  const gl::Buffer& near_lights() const { return near_lights_; }  // shared::NearLight of each light
  /// Of the pictures that are averaged all but the first: sub-lights take their own shares of a light's surroundings,
  /// by their places instead of its, and those on several surfaces are not summed (irradiance_of_sublights_apart() of
  /// shaders/screen/lights/resample/sublights.glsl). Means come out right; a picture alone is smoother without.
  bool apart() const { return apart_; }
  size_t bytes() const { return sublights_.bytes() + near_lights_.bytes(); }

 private:
  void run_source(int light, int first, int count, bool along_curve, double measure, int candidates_per_light);

  bool apart_ = false;
  gl::Buffer sublights_, near_lights_;
  gl::Program program_;
};

}  // namespace volgi::screen
