#pragma once
#include "screen/frame/stage.h"

namespace volgi::screen {

/// Shadows of virtual lights by a map for each (light_maps.h): imperfect ones (Ritschel et al. 2008), or regular ones
/// of some of the lights, the two ways of the wave lattice's text (section 4.2). Makes LightMaps.
extern const StageType IMPERFECT_VISIBILITY;

}  // namespace volgi::screen
