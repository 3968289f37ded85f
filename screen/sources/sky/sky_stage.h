#pragma once
#include "screen/frame/stage.h"

namespace volgi::screen {

/// The sky: its light straight onto surfaces (sky_gather.h), and the maps (sky_maps.h) from which stages of virtual
/// lights take its first reflection. Makes SkyMaps.
extern const StageType SKY;

/// Whether the first reflection of sky light is carried by virtual lights; else by a volume (SkyOptions::first).
bool sky_goes_by_lights(const FrameOptions& options);
/// A recipe without a volume behind a first bounce.
void prefer_sky_by_lights(TypeMap& settings);

}  // namespace volgi::screen
