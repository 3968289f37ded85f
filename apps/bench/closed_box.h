#pragma once
#include "core/scene.h"

namespace volgi::app {

/// closed_box (docs/hard-cases.md#scenes): a 2 m cube of albedo 0.7 with an emitter 0.5 m square in the ceiling's
/// middle. @param length  along z, times the cube's.
Scene closed_box(float length = 1.0f);

}  // namespace volgi::app
