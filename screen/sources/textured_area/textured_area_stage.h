#pragma once
#include "screen/frame/stage.h"

namespace volgi::screen {

/// Emissive meshes as area lights with their textures (area_lights.h), for stages that light by them. Makes AreaLights.
extern const StageType TEXTURED_AREA;

}  // namespace volgi::screen
