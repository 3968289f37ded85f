#pragma once
#include <initializer_list>
#include <span>
#include <string_view>
#include <vector>

#include "apps/volgi/frame_stats.h"
#include "core/gl/context.h"
#include "core/gl/pass_timer.h"
#include "core/image.h"
#include "core/scene.h"
#include "screen/frame/frame.h"

namespace volgi::app {

/// The picture of a scene's first camera, rendered again and again for its times. Needs a current gl::Context.
class RepeatedFrame {
 public:
  /// passes: the time of every pass as well; on a software rasterizer each then waits for the one before. whole: the
  /// frame as a user gets it, one glFinish at its end.
  enum class Timing { passes, whole };
  static constexpr int kWarmUp = 2;

  /// @param scene  must outlive this. @throws Error(bad_input) when it has no camera; as screen::Frame does.
  RepeatedFrame(const Scene& scene, const gl::Context& context, const screen::FrameOptions& options,
                Timing timing = Timing::passes);

  void render();
  /// render(), this many times after kWarmUp untimed ones.
  void render_repeatedly(int frames);
  void forget_warm_up();
  const ColdFrame& cold() const { return cold_; }  // the first one

  Image image() const;
  const screen::Frame& frame() const { return frame_; }
  gl::PassTimer& timer() { return timer_; }
  const std::vector<double>& frames_ms() const { return frames_ms_; }
  double frame_ms() const;                                          // median
  double passes_ms(std::initializer_list<std::string_view> names);  // sum of their medians
  double all_passes_ms();

 private:
  const Camera& camera_;
  screen::Frame frame_;
  gl::PassTimer timer_;
  std::vector<double> frames_ms_;
  ColdFrame cold_;
  bool rendered_ = false;
};

/// Frames of several pictures in turn, so that what else the machine does meets all alike; warm-up as above.
void render_in_turn(std::span<RepeatedFrame* const> pictures, int frames);
inline void render_in_turn(std::initializer_list<RepeatedFrame*> pictures, int frames) {
  render_in_turn(std::span(pictures.begin(), pictures.size()), frames);
}

}  // namespace volgi::app
