#pragma once
#include <span>

#include "screen/frame/parameter.h"

namespace volgi::screen {

struct Needs;

/// Parameters of passes that every picture has.
std::span<const Parameter> base_parameters();
/// What a quality asks of them, as StageType::suit.
void suit_base(const Needs& needs, TypeMap& settings);

}  // namespace volgi::screen
