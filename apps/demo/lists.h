#pragma once
#include <string>

namespace volgi::demo {

/// Keys, commands or views as a Markdown table: what docs/demo.md has.
/// @throws Error(usage) for another name.
std::string list_of(const std::string& what);

}  // namespace volgi::demo
