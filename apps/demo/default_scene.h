#pragma once
#include <filesystem>

namespace volgi::demo {

/// The Cornell box: data/cornell.glb beside the program's source or build, or where it was installed; where there is
/// none, builtin:metaballs, whose room is the same.
std::filesystem::path default_scene();

}  // namespace volgi::demo
