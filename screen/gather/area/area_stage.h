#pragma once
#include "screen/frame/stage.h"

namespace volgi::screen {

/// Light straight from emissive surfaces by virtual lights on them, coarse to fine (area_gather.h), as Nichols 2010 has
/// it in chapter 5.
extern const StageType AREA_GATHER;

}  // namespace volgi::screen
