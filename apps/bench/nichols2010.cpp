#include "apps/bench/nichols2010.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apps/bench/nichols2010_internal.h"
#include "screen/frame/registry.h"
#include "screen/gather/subsplats/discontinuity_mipmaps.h"
#include "screen/gather/subsplats/flattened_buffer.h"
#include "screen/gather/subsplats/light_cache.h"
#include "screen/gather/subsplats/splat.h"
#include "screen/gather/subsplats/stencil_gather.h"
#include "screen/gather/subsplats/subsplat_refinement.h"
#include "screen/gather/subsplats/upsample.h"

namespace volgi::app {

namespace nichols2010 {

screen::FrameOptions settings(const char* recipe, int size, std::initializer_list<std::string> set) {
  screen::FrameOptions o;
  screen::apply_recipe(recipe, o);
  o.size = glm::ivec2(size);
  o.light = screen::LightPart::indirect;
  o.bounces = 1;
  for (const std::string& s : set) screen::set_parameter(o.settings, s);
  return o;
}

void render_in_turn(const Bench& bench, std::initializer_list<RepeatedFrame*> frames) {
  for (int f = 0; f <= bench.options.frames; ++f) {
    for (RepeatedFrame* frame : frames) {
      if (f == 1) frame->forget_warm_up();
      frame->render();
    }
  }
}

Timed timed(const Bench& bench, const Scene& scene, const screen::FrameOptions& options) {
  RepeatedFrame frame(scene, bench.context, options);
  render_in_turn(bench, {&frame});
  const screen::FrameReport report = frame.frame().report();
  using namespace screen;
  const double indirect_ms =
      frame.passes_ms({DiscontinuityMipmaps::name, LightCache::name, FlattenedBuffer::mark_name, StencilGather::name,
                       SubsplatRefinement::name, Splat::name, Upsample::name});
  return {frame.frame_ms(), indirect_ms, double(report.number("fragments")), double(report.number("patches"))};
}

Image picture(const Bench& bench, const Scene& scene, const screen::FrameOptions& options) {
  RepeatedFrame frame(scene, bench.context, options, RepeatedFrame::Timing::whole);
  frame.render();
  return frame.image();
}

Rms rms(const Image& reference, const Image& image) {
  double squared = 0.0, mean = 0.0, largest = 0.0;
  for (size_t i = 0; i < reference.pixels.size(); ++i) {
    const glm::dvec3 r(reference.pixels[i]), d = glm::dvec3(image.pixels[i]) - r;
    squared += glm::dot(d, d) / 3.0;
    mean += (r.x + r.y + r.z) / 3.0;
    largest = std::max({largest, r.x, r.y, r.z});
  }
  const double count = double(reference.pixels.size());
  const double error = std::sqrt(squared / count);
  return {100.0 * error / std::max(mean / count, 1e-30), 100.0 * error / std::max(largest, 1e-30)};
}

nlohmann::json to_json(const Rms& r) { return {{"of_mean_percent", r.of_mean}, {"of_range_percent", r.of_range}}; }

std::string text_of(const nlohmann::json& rms) {
  const std::string text =
      fmt::format("{:6.2f} /{:5.2f} %", rms["of_mean_percent"].get<double>(), rms["of_range_percent"].get<double>());
  if (!rms.contains("of_white_percent")) return text;
  return text + fmt::format(" ({:.2f} %)", rms["of_white_percent"].get<double>());
}

}  // namespace nichols2010

nlohmann::json bench_nichols2010(const std::function<Scene(const std::string&)>& scene_by_name,
                                 const gl::Context& context, const Nichols2010Options& options,
                                 const std::function<void(const std::string&)>& show) {
  Nichols2010Options o = options;
  if (o.quick) {
    o.sizes = {64};
    o.error_size = 48;
    o.all_texels = 64;
    o.frames = 1;
    if (o.scenes.empty()) o.scenes = {"cornell"};
  }
  const nichols2010::Bench bench{scene_by_name, context, o, show};
  show(
      fmt::format("{}, medians of {} frames; theirs: GeForce GTX 280, 1024 x 1024\n", context.device_name(), o.frames));
  return {{"device", context.device_name()},
          {"frames", o.frames},
          {"chapter_3", nichols2010::chapter_3(bench)},
          {"chapter_4", nichols2010::chapter_4(bench)}};
}

}  // namespace volgi::app
