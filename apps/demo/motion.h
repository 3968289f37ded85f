#pragma once
#include <chrono>
#include <glm/glm.hpp>

#include "screen/frame/frame_options.h"

namespace volgi::demo {

/// How a frame is made while something moves. Each level costs less than the one before: all pixels; half of them on
/// each axis; and fewer candidates for virtual lights, smaller maps of what lamps and clusters see, and fewer cells;
/// and half as many lights and clusters. What is shown when nothing moves any more is always level 0.
inline constexpr int MOTION_LEVELS = 4;
glm::ivec2 motion_size(int level, glm::ivec2 size);
void apply_motion_level(int level, screen::FrameOptions& options);

/// Chooses the level: the lowest that has kept the rate so far. Times of a level that is not used any more are
/// forgotten when reset() says that frames cost something else from here on.
class MotionPace {
 public:
  using Clock = std::chrono::steady_clock;
  void reset();
  /// Something moved now.
  void moved(Clock::time_point now) { moved_ = now; }
  /// Whether something has moved a moment ago.
  bool moving(Clock::time_point now) const;
  /// A frame of level() has been shown, after another one. @param least_fps  0: level 0 always.
  void shown(double seconds, double least_fps);
  int level() const { return level_; }

 private:
  Clock::time_point moved_{};
  int level_ = 0;
  int slow_ = 0;  // frames in a row
};

}  // namespace volgi::demo
