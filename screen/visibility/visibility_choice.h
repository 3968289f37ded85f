#pragma once
#include <optional>

#include "screen/frame/type_map.h"

namespace volgi::screen {

/// How virtual lights' shadows are made, where a recipe leaves the choice.
struct VisibilityChoice {
  enum class Maps {
    none,
    imperfect,  // from points on surfaces (Ritschel et al. 2008)
    regular,    // from triangles
  };
  std::optional<Maps> maps;  // none: as the recipe has it
  /// What hides lights on emissive surfaces from pixels.
  enum class Ways {
    none,
    voxels,  // of the camera's frustum (Nichols 2010)
    faces,   // that the volume blocks
    rays,    // of the CPU, exact
  } ways = Ways::voxels;
};

/// As the wave lattice's text has it first.
inline void prefer_imperfect_maps(TypeMap& settings) {
  auto& maps = settings.of<VisibilityChoice>().maps;
  if (!maps) maps = VisibilityChoice::Maps::imperfect;
}

}  // namespace volgi::screen
