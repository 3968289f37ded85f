#pragma once
// Where the source tree and the build are: in one object of its own, so that no other test depends on the place.
#include <filesystem>

namespace volgi::test {

std::filesystem::path source_dir();
std::filesystem::path build_dir();

}  // namespace volgi::test
