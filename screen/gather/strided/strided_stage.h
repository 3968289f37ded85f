#pragma once
#include "screen/frame/stage.h"

namespace volgi::screen {

/// Virtual lights summed at every n-th pixel and where pixels differ (virtual_light_gather.h), less negative lights
/// where there are some.
extern const StageType STRIDED_GATHER;

}  // namespace volgi::screen
