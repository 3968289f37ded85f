#pragma once
#include "screen/visibility/area_maps/area_light_shadow.h"
#include "shaders/screen/visibility/area_maps/slots.shared.h"

namespace volgi::screen {

/// Hard shadow of the area light's middle. Cost: a look-up reads four texels
/// (shaders/screen/visibility/area_maps/single_shadow.glsl).
class SingleShadow final : public AreaLightShadow {
 public:
  void run(const ParaboloidDepthMaps&, gl::PassTimer&) override {}
  std::string define() const override { return "AREA_LIGHT_SHADOW_SINGLE"; }
  void bind(const ParaboloidDepthMaps& maps, const gl::Program&) const override {
    maps.distance().bind(SHADOW_DISTANCE_UNIT);
  }
  size_t bytes() const override { return 0; }
};

}  // namespace volgi::screen
