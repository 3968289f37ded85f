#pragma once
// One picture through screen::Frame, for tests.
#include <vector>

#include "core/gl/context.h"
#include "core/gl/pass_timer.h"
#include "screen/frame.h"
#include "screen/image_from_texture.h"

namespace volgi::test {

struct Rendered {
  Image image;
  screen::FrameReport report;
};

inline Rendered render(const gl::Context& context, const Scene& scene, const Camera& camera,
                       const screen::FrameOptions& options) {
  screen::Frame frame(scene, options);
  gl::PassTimer timer(context.software(), false);
  frame.render(camera, timer);
  return {screen::image_from_texture(frame.radiance()), frame.report()};
}

}  // namespace volgi::test
