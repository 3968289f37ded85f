#pragma once
#include <filesystem>

namespace volgi {

/// OpenEXR (3.1) makes texts as long as a file's header says before it reads them: every length of a header is held
/// against the file's own first.
/// @throws std::runtime_error where one does not fit.
void check_exr_header(const std::filesystem::path& path);

}  // namespace volgi
