#pragma once
#include <span>

#include "screen/frame/parameter.h"

namespace volgi::screen {

/// Parameters of passes that every picture has.
std::span<const Parameter> base_parameters();

}  // namespace volgi::screen
