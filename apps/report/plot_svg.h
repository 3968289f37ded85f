#pragma once
#include <string>

#include "apps/report/verdict.h"

namespace volgi::app {

/// Error against time, both logarithmic, as an SVG picture without script: every point with a title that says what it
/// is, the front as a line, a legend. For where nothing can be pointed at, such as Markdown.
/// @param standalone  with its own colours (for a file); else it takes those of the page's style sheet.
std::string plot_svg(const Verdict& verdict, bool standalone);

}  // namespace volgi::app
