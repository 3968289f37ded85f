#pragma once
#include <filesystem>
#include <functional>

namespace volgi::app {

/// Does what a library may crash at, on a file from anywhere, in a process of its own, whose failures are said there
/// (failure.h). `work` starts its own threads: those of the parent are not there.
/// @return the exit code of `work`.
/// @throws Error(bad_input) naming the file where a signal has ended the process.
int in_a_child(const std::filesystem::path& file, const std::function<int()>& work);

}  // namespace volgi::app
