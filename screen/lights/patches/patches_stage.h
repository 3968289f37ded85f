#pragma once
#include "screen/frame/stage.h"

namespace volgi::screen {

/// Virtual lights that are squares of reflective shadow maps, and their tree (light_patches.h). Makes
/// VirtualLightListGl, and LightPatchTree with patches.method=hierarchical.
extern const StageType LIGHT_PATCHES;

/// As recipes that take their lights from here have it.
void prefer_light_grid(TypeMap& settings);
void prefer_light_patches(TypeMap& settings);
void prefer_light_hierarchy(TypeMap& settings);

/// Whether fragments choose from a tree themselves, with these options.
bool lights_are_a_hierarchy(const FrameOptions& options);

}  // namespace volgi::screen
