#pragma once
#include <chrono>
#include <filesystem>

namespace volgi::demo {

/// Tells when a file of the folder of shaders has changed; looks twice a second.
class ShaderWatch {
 public:
  /// @param folder  empty: nothing to watch. Shaders are read from there from now on. @throws Error(usage) when it is
  /// no folder.
  explicit ShaderWatch(const std::filesystem::path& folder);
  bool changed();

 private:
  bool watches_;
  std::filesystem::file_time_type last_;
  std::chrono::steady_clock::time_point looked_;
};

}  // namespace volgi::demo
