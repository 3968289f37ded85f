#pragma once
#include "screen/frame/frame_options.h"
#include "screen/frame/light_path.h"
#include "screen/frame/type_map.h"

namespace volgi::screen {

/// Which stage's virtual lights a recipe has.
struct LightChoice {
  enum class Stage { rsm, lattice, patches } stage = Stage::rsm;
};

/// As a recipe of the wave lattice has it.
inline void prefer_wave_lattice(TypeMap& settings) { settings.of<LightChoice>().stage = LightChoice::Stage::lattice; }

/// Reflected light that virtual lights carry with these options. Those of a lattice stand for all reflections.
LightPaths reflected_paths(const FrameOptions& options);
/// All light that they carry.
LightPaths paths_by_lights(const FrameOptions& options);

}  // namespace volgi::screen
