#pragma once
#include "screen/frame/stage.h"

namespace volgi::screen {

/// All light but punctual direct light through the volume, on the GPU or by its CPU twin (frame_volume.h).
extern const StageType VOLUME;

/// What comes after a first bounce on the screen: bounces 2 ... n of punctual light and 1 ... n of emission, from what
/// virtual lights bring to the volume's sides, with the visibility that pixels have (docs/theory.md#composition).
extern const StageType VOLUME_AFTER_FIRST_BOUNCE;

/// Preset of the recipe "lpv".
void prefer_lpv(TypeMap& settings);

}  // namespace volgi::screen
