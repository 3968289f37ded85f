#pragma once
#include "screen/frame/stage.h"

namespace volgi::screen {

/// Lights to subtract where virtual lights shine through bodies (negative_lights.h). Makes NegativeLights.
extern const StageType NEGATIVE_LIGHTS_STAGE;

}  // namespace volgi::screen
