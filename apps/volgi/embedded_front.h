#pragma once
#include <string_view>

namespace volgi::app {

/// Text that was built into the program: "front.json".
std::string_view embedded_front(std::string_view name);

}  // namespace volgi::app
