#pragma once
#include "screen/frame/type_map.h"

namespace volgi::screen {

/// Which stage gathers the light of clustered virtual lights.
struct GatherChoice {
  enum class Stage { interleaved, multires } stage = Stage::multires;
};

/// As Dong et al. 2009 print it: every light at every pixel, interleaved.
inline void prefer_interleaved_gather(TypeMap& settings) {
  settings.of<GatherChoice>().stage = GatherChoice::Stage::interleaved;
}

}  // namespace volgi::screen
