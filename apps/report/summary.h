#pragma once
#include <filesystem>

#include "apps/report/export.h"

namespace volgi::app {

/// Writes a Markdown file that says what the report comes to, and beside it a folder of the same name with the plots
/// and pictures that it shows: what is worth committing of a report.
/// @param folder  of the report, where the pictures are. @throws Error(cannot_write).
void write_summary(const Report& report, const std::filesystem::path& folder, const std::filesystem::path& markdown);

}  // namespace volgi::app
