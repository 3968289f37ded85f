#pragma once
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "apps/volgi/frame_options.h"
#include "core/camera.h"
#include "screen/frame/choice.h"

namespace volgi::app {

/// What --gi auto has chosen, and what from.
struct Automatic {
  FrameCommandOptions frame;  // as asked, with what was chosen in place of auto
  screen::Budget budget;
  screen::Choice choice;
  screen::MeasuredFront front;  // its times on this device, as far as anybody knows
  bool calibrated = false;      // `volgi calibrate` has measured them

  /// Two lines: what, and why.
  std::string summary() const;
  /// A line for each setting that was not chosen: what it would take and show.
  std::string rejected() const;
  nlohmann::json json() const;
};

/// Chooses where --gi is auto; none where it is not.
/// @param device  gl::Context::device_name(). @param one_picture  not what averages several.
/// @throws Error(usage) where no setting goes with the other options; Error as fit() does.
std::optional<Automatic> choose_automatically(const FrameCommandOptions& asked, const Scene& scene,
                                              const Camera& camera, glm::ivec2 size, const std::string& device,
                                              bool one_picture = false);

}  // namespace volgi::app
