#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "apps/demo/viewer.h"

namespace volgi::demo {

/// What a person can do, as a line of text: keys, menus, the palette, scripts and tests all say it this way.
struct Command {
  const char* name;
  const char* arguments;  // "NAME=VALUE"; empty: none
  const char* help;
  void (*run)(Viewer& viewer, const std::string& arguments);
};
std::span<const Command> commands();

/// @param line  "set vpl.count=2048".
/// @throws Error(usage) for a command that there is not, naming those that begin alike, and for arguments that it does
/// not take; Error as what it does.
void execute(Viewer& viewer, std::string_view line);
/// What a line that is being typed may become, for the palette: whole lines, best first.
std::vector<std::string> completions(const Viewer& viewer, std::string_view line);

}  // namespace volgi::demo
