#pragma once
#include "screen/frame/stage.h"

namespace volgi::screen {

/// Virtual lights of the wave lattice (wave_lattice.h), which stand for all reflections. Makes VirtualLightListGl.
extern const StageType LATTICE_LIGHTS;

}  // namespace volgi::screen
