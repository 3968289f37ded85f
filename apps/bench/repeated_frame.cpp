#include "apps/bench/repeated_frame.h"

#include <epoxy/gl.h>

#include <algorithm>

#include "apps/bench/timing.h"
#include "core/error.h"
#include "screen/base/image_from_texture.h"

namespace volgi::app {

namespace {

const Camera& first_camera(const Scene& scene) {
  if (scene.cameras.empty())
    throw Error(ExitCode::bad_input, scene.path.string() + ": a benchmark scene needs a camera");
  return scene.cameras[0];
}

}  // namespace

RepeatedFrame::RepeatedFrame(const Scene& scene, const gl::Context& context, const screen::FrameOptions& options,
                             Timing timing)
    : camera_(first_camera(scene)), frame_(scene, options), timer_(context.software(), timing == Timing::passes) {}

void RepeatedFrame::render() {
  glFinish();
  frames_ms_.push_back(time_ms([&] {
    timer_.begin_frame();
    frame_.render(camera_, timer_);
    timer_.end_frame();
    glFinish();
  }));
  if (!rendered_) cold_ = cold_frame(timer_);
  rendered_ = true;
}

void RepeatedFrame::render_repeatedly(int frames) { render_in_turn({this}, frames); }

void RepeatedFrame::forget_warm_up() {
  timer_.reset();
  frames_ms_.clear();
}

Image RepeatedFrame::image() const { return screen::image_from_texture(frame_.radiance()); }

double RepeatedFrame::frame_ms() const { return median(frames_ms_); }

double RepeatedFrame::passes_ms(std::initializer_list<std::string_view> names) {
  double sum = 0.0;
  for (const auto& pass : timer_.medians()) {
    if (std::find(names.begin(), names.end(), pass.name) != names.end()) sum += pass.gpu_ms;
  }
  return sum;
}

double RepeatedFrame::all_passes_ms() {
  double sum = 0.0;
  for (const auto& pass : timer_.medians()) sum += pass.gpu_ms;
  return sum;
}

void render_in_turn(std::span<RepeatedFrame* const> pictures, int frames) {
  for (int f = 0; f < RepeatedFrame::kWarmUp + frames; ++f) {
    for (RepeatedFrame* picture : pictures) {
      if (f == RepeatedFrame::kWarmUp) picture->forget_warm_up();
      picture->render();
    }
  }
}

}  // namespace volgi::app
