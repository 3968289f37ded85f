#pragma once
#include <glm/glm.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/volgi/frame_options.h"
#include "core/gl/context.h"
#include "core/gl/pass_timer.h"
#include "screen/frame/frame_report.h"

namespace volgi::app {

/// What a program's first frame takes: shaders are compiled in it and memory is touched for the first time.
struct ColdFrame {
  double frame_ms = 0.0;
  std::vector<gl::PassTimer::PassTime> passes;
};
/// @param timer  after one frame.
ColdFrame cold_frame(gl::PassTimer& timer);

/// The frames whose times a timer holds, and the cold one, which is among them only where there was no other.
struct TimedFrames {
  int count = 0;
  bool warm = false;
  ColdFrame cold;
};

/// The --stats object (docs/conventions.md#statistics): scene, mode, size, device, times per pass and frame, grid,
/// orders, memory.
nlohmann::json frame_stats(const std::string& scene, const std::string& mode, glm::ivec2 size,
                           const gl::Context& context, gl::PassTimer& timer, const TimedFrames& frames,
                           const screen::FrameReport& report);
/// --stats' "quality": what the scene asked for, what was chosen, and what each rung of a climb has changed.
nlohmann::json quality_json(const std::string& quality, const FrameCommandOptions::Fitted& fitted,
                            const screen::Climb& climb);
/// The same as a table for people: one line a pass, then the frame.
std::string pass_table(const nlohmann::json& stats);

}  // namespace volgi::app
