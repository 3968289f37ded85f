#pragma once
#include "screen/frame/stage.h"
#include "screen/visibility/area_maps/area_light_shadow.h"

namespace volgi::screen {

struct AreaMapOptions {
  int texels = 256;  // on each side of an area light's map
  AreaLightShadow::Method shadow = AreaLightShadow::Method::single;
  AreaLightShadow::Filter filter = AreaLightShadow::Filter::map;  // of convolution
};

/// Virtual lights in clusters that share a shadow (Dong et al. 2009): virtual_area_lights.h, paraboloid_depth_maps.h,
/// area_light_shadow.h. Makes LightClusters.
extern const StageType AREA_MAPS;

}  // namespace volgi::screen
