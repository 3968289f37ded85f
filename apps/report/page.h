#pragma once
#include <filesystem>
#include <string>

#include "apps/report/export.h"

namespace volgi::app {

/// The report as one HTML file that opens from disk: style, script, Chart.js, points and pictures are in it. Pictures
/// of points on a front and of techniques at their defaults; the others stay in `folder`/pictures.
std::string report_page(const Report& report, const std::filesystem::path& folder);

/// The part of one scene: verdicts, still plot, pictures and table of each light.
std::string scene_section(const Report& report, const std::string& scene, const std::filesystem::path& folder);

/// A table of texts, the first row is its head; numbers are recognised.
std::string plain_table(const std::vector<std::vector<std::string>>& rows);

}  // namespace volgi::app
