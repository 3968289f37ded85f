#include "core/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "core/log.h"

namespace volgi {
namespace {

constexpr std::int64_t quiet_start_ms = 1000;  // shorter work shows nothing
constexpr std::int64_t redraw_ms = 200;

std::string remaining_time(double seconds) {
  const std::int64_t whole = std::llround(std::min(seconds, 359999.0));
  if (whole >= 3600) return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
  return fmt::format("{}:{:02}", whole / 60, whole % 60);
}

}  // namespace

Progress::Progress(std::string title, std::uint64_t total_steps)
    : title_(std::move(title)),
      total_(std::max<std::uint64_t>(total_steps, 1)),
      start_(std::chrono::steady_clock::now()),
      enabled_(!is_quiet() && isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
  if (!drawn_) return;
  std::fputs("\r\x1b[K", stderr);
  std::fflush(stderr);
}

void Progress::advance(std::uint64_t steps) {
  const std::uint64_t done = done_.fetch_add(steps) + steps;
  if (!enabled_) return;
  const auto elapsed = std::chrono::steady_clock::now() - start_;
  const auto now_ms = std::chrono::duration_cast<std::chrono::milliseconds>(elapsed).count();
  std::int64_t last = last_draw_ms_;
  if (now_ms < quiet_start_ms || now_ms - last < redraw_ms) return;
  if (last_draw_ms_.compare_exchange_strong(last, now_ms)) draw(done);  // one thread draws, the others go on
}

void Progress::draw(std::uint64_t done) {
  const std::lock_guard lock(mutex_);
  const double share = std::min(1.0, double(done) / double(total_));
  const double elapsed_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  const double remaining_s = share > 0.0 ? elapsed_s * (1.0 - share) / share : 0.0;
  constexpr size_t width = 30;
  const size_t filled = size_t(share * width);
  const std::string bar = std::string(filled, '#') + std::string(width - filled, '.');
  const std::string line =
      fmt::format("\r{} [{}] {:3.0f} %, {} left\x1b[K", title_, bar, share * 100.0, remaining_time(remaining_s));
  std::fputs(line.c_str(), stderr);
  std::fflush(stderr);
  drawn_ = true;
}

}  // namespace volgi
