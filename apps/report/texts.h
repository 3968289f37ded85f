#pragma once
#include <string_view>

namespace volgi::app {

/// A file that was built into the program: "full.json", "quick.json", "papers.json", "page.html", "page.css",
/// "page.js", and "chart.js", which is empty where the build found no Chart.js. The name must be one of these.
std::string_view report_text(std::string_view name);

}  // namespace volgi::app
