#pragma once
#include "screen/frame/stage.h"

namespace volgi::screen {

/// Virtual lights from reflective shadow maps and emissive surfaces (virtual_lights.h), or candidates for them where a
/// later stage chooses. Makes VirtualLights and VirtualLightListGl.
extern const StageType RSM_LIGHTS;

}  // namespace volgi::screen
