#pragma once
#include <filesystem>
#include <string>

namespace volgi::app {

/// The frames of an animation: frame k shows the time first_s + k / frames_per_s.
struct FrameTimes {
  double first_s = 0.0;
  double frames_per_s = 25.0;
  int count = 1;

  static constexpr int kMaxCount = 100000;
  double at(int frame) const { return first_s + frame / frames_per_s; }
};

/// Frames from T0 to T1, both included where FPS has a frame there, from the text T0:T1:FPS (seconds, seconds, frames a
/// second). @throws Error(usage) unless T0 <= T1, FPS > 0 and there are at most FrameTimes::kMaxCount.
FrameTimes parse_frame_times(const std::string& text);

/// Name of a frame's picture: its number in four digits or more, where the name has %d or %0Nd (N digits then), else
/// before the extension: out.png makes out.0000.png.
std::filesystem::path frame_path(const std::filesystem::path& out, int frame);

}  // namespace volgi::app
