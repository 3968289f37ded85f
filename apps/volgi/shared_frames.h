#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "core/claims.h"

namespace volgi::app {

/// The frames of one animation, made by several processes that run the same command. A folder says which frames are
/// done (frame-0003.done), who is at work (core/claims.h), which command all of them run, and the exposure they share.
class SharedFrames {
 public:
  /// @throws Error(usage) where the folder is of another command, naming both; Error(cannot_write).
  explicit SharedFrames(const std::filesystem::path& folder);

  /// Frames first … first + count − 1; returns when they are done, whoever has made them.
  void work(int first, int count, const std::function<void(int)>& frame);

  /// Of the first frame, for all: kept before that frame counts as done.
  void keep_exposure(float stops);
  float exposure() const;  // @throws Error(bad_input) where none is kept

 private:
  Claims claims_;
};

/// The words of this process's command line after the program's name, but for those that may differ between workers:
/// where to write times, the device, how much to print, threads.
std::string shared_command(const std::vector<std::string>& words);

}  // namespace volgi::app
