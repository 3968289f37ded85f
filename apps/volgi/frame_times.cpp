#include "apps/volgi/frame_times.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string_view>

#include "apps/volgi/parse_number.h"
#include "core/error.h"

namespace volgi::app {

namespace {

[[noreturn]] void refuse(const std::string& text, const std::string& what) {
  throw Error(ExitCode::usage, fmt::format("--animate '{}': {}", text, what));
}

/// T0, T1, FPS.
std::array<double, 3> parse_numbers(const std::string& text) {
  std::array<double, 3> numbers{};
  std::string_view rest = text;
  for (size_t i = 0; i < 3; ++i) {
    const size_t colon = rest.find(':');
    const auto number = parse_number<double>(rest.substr(0, colon));
    if (!number || (colon == std::string_view::npos) != (i == 2))
      refuse(text, "give T0:T1:FPS, seconds and frames a second, such as 0:4:25");
    numbers[i] = *number;
    rest.remove_prefix(colon == std::string_view::npos ? rest.size() : colon + 1);
  }
  return numbers;
}

}  // namespace

FrameTimes parse_frame_times(const std::string& text) {
  const auto [first_s, last_s, frames_per_s] = parse_numbers(text);
  if (first_s > last_s) refuse(text, "T1 lies before T0; give T0:T1:FPS with T0 <= T1");
  if (!(frames_per_s > 0.0)) refuse(text, "FPS must be above 0");
  // A time that is a frame's but for rounding is a frame's.
  const double steps = std::floor((last_s - first_s) * frames_per_s * (1.0 + 1e-12) + 1e-9);
  if (!(steps + 1.0 <= FrameTimes::kMaxCount)) {
    refuse(text, fmt::format("makes {:.0f} frames, more than {}; give a shorter time or a lower FPS", steps + 1.0,
                             FrameTimes::kMaxCount));
  }
  return {first_s, frames_per_s, int(steps) + 1};
}

std::filesystem::path frame_path(const std::filesystem::path& out, int frame) {
  const std::string name = out.filename().string();
  for (size_t at = name.find('%'); at != std::string::npos; at = name.find('%', at + 1)) {
    const std::string_view rest = std::string_view(name).substr(at + 1);
    const bool padded = rest.size() >= 3 && rest[0] == '0' && rest[1] >= '1' && rest[1] <= '9' && rest[2] == 'd';
    if (!padded && !rest.starts_with('d')) continue;
    const int digits = padded ? rest[1] - '0' : 1;
    return out.parent_path() /
           fmt::format("{}{:0{}}{}", name.substr(0, at), frame, digits, rest.substr(padded ? 3 : 1));
  }
  return out.parent_path() / fmt::format("{}.{:04}{}", out.stem().string(), frame, out.extension().string());
}

}  // namespace volgi::app
