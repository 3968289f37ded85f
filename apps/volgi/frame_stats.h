#pragma once
#include <glm/glm.hpp>
#include <nlohmann/json.hpp>
#include <string>

#include "core/gl/context.h"
#include "core/gl/pass_timer.h"
#include "screen/frame/frame_report.h"

namespace volgi::app {

/// The --stats object (docs/conventions.md#statistics): scene, mode, size, device, times per pass and frame, grid,
/// orders, memory.
nlohmann::json frame_stats(const std::string& scene, const std::string& mode, glm::ivec2 size,
                           const gl::Context& context, gl::PassTimer& timer, int frames,
                           const screen::FrameReport& report);
/// The same as a table for people: one line a pass, then the frame.
std::string pass_table(const nlohmann::json& stats);

}  // namespace volgi::app
