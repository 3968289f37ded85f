#pragma once
#include <optional>

#include "core/gl/objects.h"
#include "core/gl/pass_timer.h"
#include "core/gl/program.h"
#include "core/gl/readback.h"
#include "core/image.h"
#include "shaders/screen/display/exposure_meter.shared.h"

namespace volgi::screen {

/// Pass "screen/display/exposure_meter": what automatic_exposure_ev() says of a picture, from METERED_EDGE^2 of its
/// pixels and a few frames late: nothing waits for it.
class ExposureMeter {
 public:
  static constexpr const char* name = "screen/display/exposure_meter";
  ExposureMeter();
  /// @param radiance  RGBA32F.
  void run(const gl::Texture& radiance, gl::PassTimer& timer);
  /// Of the newest picture that has come back; none before the first.
  std::optional<float> exposure_ev();
  /// Waits for those under way.
  std::optional<float> wait();

 private:
  void take();
  gl::Buffer samples_;
  gl::Readback readback_;
  gl::Program program_;
  Image image_;
  std::optional<float> exposure_ev_;
};

}  // namespace volgi::screen
