#include "apps/demo/time_log.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/atomic_file.h"

namespace volgi::demo {

void TimeLog::add(double ms, std::vector<gl::PassTimer::PassTime> passes) {
  frames_.push_back({ms, std::move(passes)});
  if (frames_.size() <= KEPT) return;
  frames_.pop_front();
  ++first_;
}

void TimeLog::write_csv(const std::filesystem::path& path) const {
  std::string text = "frame,pass,gpu_ms,cpu_ms\n";
  for (size_t k = 0; k < frames_.size(); ++k) {
    text += fmt::format("{},frame,{:.3f},\n", first_ + k, frames_[k].ms);
    for (const auto& p : frames_[k].passes)
      text += fmt::format("{},{},{:.3f},{:.3f}\n", first_ + k, p.name, p.gpu_ms, p.cpu_ms);
  }
  write_text_atomically(path, text);
}

double TimeLog::median_ms() const {
  std::vector<double> ms;
  for (const Frame& frame : frames_) ms.push_back(frame.ms);
  if (ms.empty()) return 0.0;
  const auto middle = ms.begin() + std::ptrdiff_t(ms.size() / 2);
  std::nth_element(ms.begin(), middle, ms.end());
  return *middle;
}

}  // namespace volgi::demo
