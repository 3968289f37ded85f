#pragma once
#include "screen/frame/stage.h"

namespace volgi::screen {

/// What mirrors of facets reflect, apart from all that is lit evenly (lobe_rays.h): of the volume's surfaces
/// (side_radiosity.h), of emission and of the sky, in a scene that shines.
extern const StageType GLOSSY;

}  // namespace volgi::screen
