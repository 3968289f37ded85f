#pragma once
#include "screen/visibility/area_maps/area_light_shadow.h"
#include "screen/visibility/area_maps/paraboloid_depth_maps.h"
#include "screen/visibility/area_maps/virtual_area_lights.h"

namespace volgi::screen {

/// How far each virtual light is seen: as far as its area light is.
struct LightClusters {
  static constexpr const char* product_name = "clusters of virtual lights";
  const VirtualAreaLights& area_lights;
  const ParaboloidDepthMaps& maps;
  const AreaLightShadow& shadow;
};

}  // namespace volgi::screen
