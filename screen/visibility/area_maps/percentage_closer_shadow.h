#pragma once
#include "screen/visibility/area_maps/area_light_shadow.h"
#include "shaders/screen/visibility/area_maps/slots.shared.h"

namespace volgi::screen {

/// Soft shadows by comparisons in the depth maps themselves, spread over the penumbra; nothing is filtered beforehand.
/// Cost: a look-up reads 8 texels, and 16 more where it meets a blocker
/// (shaders/screen/visibility/area_maps/percentage_closer_shadow.glsl).
class PercentageCloserShadow final : public AreaLightShadow {
 public:
  void run(const ParaboloidDepthMaps&, gl::PassTimer&) override {}
  std::string define() const override { return "AREA_LIGHT_SHADOW_PERCENTAGE_CLOSER"; }
  void bind(const ParaboloidDepthMaps& maps, const gl::Program&) const override {
    maps.distance().bind(SHADOW_DISTANCE_UNIT);
  }
  size_t bytes() const override { return 0; }
};

}  // namespace volgi::screen
