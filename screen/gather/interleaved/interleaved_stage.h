#pragma once
#include "screen/frame/stage.h"

namespace volgi::screen {

/// Virtual lights of clusters, summed at pixels that share them and blurred (area_light_gather.h); what is near a light
/// gets the light of its parts (near_lights.h).
extern const StageType INTERLEAVED_GATHER;

}  // namespace volgi::screen
