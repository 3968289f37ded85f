#pragma once
#include <atomic>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <string>

namespace volgi {

/// A progress bar with percentage and remaining time on stderr: only when stderr is a terminal, not quiet, and the work
/// has lasted longer than a second. advance() may be called from any thread.
class Progress {
 public:
  Progress(std::string title, std::uint64_t total_steps);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  void advance(std::uint64_t steps = 1);

 private:
  void draw(std::uint64_t done);
  std::string title_;
  std::uint64_t total_;
  std::atomic<std::uint64_t> done_{0};
  std::chrono::steady_clock::time_point start_;
  std::atomic<std::int64_t> last_draw_ms_{0};
  std::mutex mutex_;
  bool enabled_;
  bool drawn_ = false;
};

}  // namespace volgi
