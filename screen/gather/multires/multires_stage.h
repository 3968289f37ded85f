#pragma once
#include "screen/frame/stage.h"

namespace volgi::screen {

/// The light of all virtual lights by a soft cut through their tree (light_tree.h, light_cut.h), at the pixels that
/// need it (screen/base/smooth_pixels.h), together with what later stages gather there. Makes SmoothGather.
extern const StageType MULTIRES_GATHER;

}  // namespace volgi::screen
