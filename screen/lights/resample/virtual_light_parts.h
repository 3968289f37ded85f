#pragma once
#include "core/gl/objects.h"
#include "core/gl/pass_timer.h"
#include "core/gl/program.h"
#include "screen/base/reflective_shadow_map.h"
#include "screen/lights/resample/choose_virtual_lights.h"
#include "screen/lights/rsm/virtual_lights.h"

namespace volgi::screen {

/// Pass "screen/lights/resample/virtual_light_parts": looks closer at what each chosen virtual light stands for, its
/// piece of Hilbert's curve through what its source sends: LIGHT_PARTS new samples of the reflective shadow map at
/// equal steps, and four quarters, the sums of four parts each. What is near a light is lit by these (NearLights).
/// Pieces of emitters, and of lights that are sampled by flux, take the candidates that they hold. Cost: as
/// VirtualLights with so many lights.
class VirtualLightParts {
 public:
  static constexpr const char* name = "screen/lights/resample/virtual_light_parts";
  static constexpr const char* product_name = "parts of virtual lights";
  VirtualLightParts();

  /// @param chosen  of `candidates`.
  void run(const ReflectiveShadowMap& maps, const VirtualLights& candidates, const ChooseVirtualLights& chosen,
           gl::PassTimer& timer);

  const gl::Buffer& pieces() const { return pieces_; }            // shared::LightPiece, LIGHT_PIECES for each light
  const gl::Buffer& near_lights() const { return near_lights_; }  // shared::NearLight of each light
  size_t bytes() const { return pieces_.bytes() + near_lights_.bytes(); }

 private:
  void run_source(int light, int first, int count, bool along_curve, double measure, int one_of);

  gl::Buffer pieces_, near_lights_;
  gl::Program program_;
};

}  // namespace volgi::screen
