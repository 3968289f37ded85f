#pragma once
#include <string>
#include <utility>
#include <vector>

#include "screen/frame/frame_options.h"
#include "screen/frame/parameter.h"

namespace volgi::demo {

/// Parameters that are not what their recipe has, each with the shortest text that --set takes for this very value.
std::vector<std::pair<const screen::Parameter*, std::string>> parameters_set(const screen::FrameOptions& options);

}  // namespace volgi::demo
