#pragma once
#include <deque>
#include <filesystem>
#include <vector>

#include "core/gl/pass_timer.h"

namespace volgi::demo {

/// Times of the last frames: of each as a whole, and of its passes where those are timed.
class TimeLog {
 public:
  static constexpr size_t KEPT = 2000;
  /// @param ms  from one picture to the next. @param passes  PassTimer::latest(): of a GPU, of some frames before.
  void add(double ms, std::vector<gl::PassTimer::PassTime> passes);
  /// frame,pass,gpu_ms,cpu_ms; the whole frame as pass "frame". @throws Error(cannot_write).
  void write_csv(const std::filesystem::path& path) const;
  size_t size() const { return frames_.size(); }
  double median_ms() const;

 private:
  struct Frame {
    double ms;
    std::vector<gl::PassTimer::PassTime> passes;
  };
  std::deque<Frame> frames_;
  size_t first_ = 0;  // number of frames_.front()
};

}  // namespace volgi::demo
