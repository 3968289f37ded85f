#include "apps/report/renderers.h"

#include <CLI/CLI.hpp>
#include <algorithm>

#include "apps/bench/timing.h"
#include "apps/report/added_picture.h"
#include "apps/volgi/automatic.h"
#include "apps/volgi/frame_options.h"
#include "core/error.h"
#include "core/gl/pass_timer.h"
#include "core/log.h"
#include "reference/path_integrator.h"
#include "reference/path_tracer.h"
#include "screen/base/image_from_texture.h"
#include "screen/frame/frame.h"

namespace volgi::app {
namespace {

void parse(CLI::App& command, const std::vector<std::string>& options) {
  try {
    command.parse(std::vector<std::string>(options.rbegin(), options.rend()));
  } catch (const CLI::ParseError& error) {
    throw Error(ExitCode::usage, error.what());
  }
}

struct AskedFrame {
  FrameCommandOptions command;
  screen::FrameOptions options;
  bool by_quality = false;  // that --quality names: without it a technique is measured as its options have it
};

AskedFrame frame_options(const std::vector<std::string>& options, const std::string& light, glm::ivec2 size) {
  CLI::App command;
  AskedFrame asked;
  asked.command.add_to(command);
  parse(command, options);
  asked.command.light = light;
  asked.options = asked.command.frame_options(size);
  asked.by_quality =
      command.count("--quality") > 0 || command.count("--cells-times") > 0 || command.count("--lights-times") > 0;
  if (screen::quality_from_name(asked.command.quality) == screen::Quality::truth)
    throw Error(ExitCode::usage, "--quality truth climbs from picture to picture, which is no frame to time");
  return asked;
}

/// The mean of the picture that there is and of `count` - 1 others.
Image mean_of_samples(screen::Frame& frame, const Camera& camera, int count, gl::PassTimer& timer) {
  Image image = screen::image_from_texture(frame.radiance());
  for (int k = 1; k < count; ++k) {
    frame.set_sample(k, true);
    frame.render(camera, timer);
    const Image other = screen::image_from_texture(frame.radiance());
    for (size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] += other.pixels[i];
  }
  for (glm::vec3& p : image.pixels) p /= float(count);
  return image;
}

Rendering render_frames(const RenderTask& task) {
  AskedFrame asked = frame_options(task.options, task.light, task.size);
  if (const auto automatic =
          choose_automatically(asked.command, task.scene, task.camera, task.size, task.context.device_name())) {
    asked.command = automatic->frame;
    asked.options = asked.command.frame_options(task.size);
    asked.by_quality = true;
  }
  const glm::vec3 eye(task.camera.world_from_camera[3]);
  const int samples = asked.by_quality ? asked.command.fit(task.scene, eye, 0, asked.options).needs.samples : 1;
  screen::Frame frame(task.scene, asked.options);
  gl::PassTimer timer(task.context.software(), true);
  const int warm_up = warm_up_frames(task.frames);
  std::vector<double> cpu_ms;
  for (int f = 0; f < warm_up + task.frames; ++f) {
    if (f == warm_up) timer.reset();
    const double before_ms = processor_ms();
    timer.begin_frame();
    frame.render(task.camera, timer);
    timer.end_frame();
    if (f >= warm_up) cpu_ms.push_back(processor_ms() - before_ms);
  }
  Rendering out;
  gl::PassTimer untimed(task.context.software(), false);
  out.picture = mean_of_samples(frame, task.camera, samples, untimed);
  for (const auto& pass : timer.medians()) out.passes.push_back({{"name", pass.name}, {"ms", pass.gpu_ms}});
  const auto time = timer.frame_time();
  out.min_ms = samples * time.min_ms;  // of the picture: passes are of one sample
  out.median_ms = samples * time.median_ms;
  out.max_ms = samples * time.max_ms;
  out.cpu_ms = samples * median(cpu_ms);
  out.timer = timer.kind() == gl::PassTimer::Kind::gpu ? "gpu" : "wall";
  out.memory_bytes = frame.report().memory_bytes;
  return out;
}

PathTracerOptions tracer_options(const std::vector<std::string>& options) {
  CLI::App command;
  PathTracerOptions tracer;
  int bounces = -1;
  command.add_option("--spp", tracer.samples_per_pixel);
  command.add_option("--seed", tracer.seed);
  command.add_option("--bounces", bounces);
  parse(command, options);
  if (bounces >= 0) tracer.max_bounces = bounces;
  return tracer;
}

Rendering trace_paths(const RenderTask& task) {
  PathTracerOptions tracer = tracer_options(task.options);
  tracer.size = task.size;
  tracer.light = task.light == "indirect" ? PathTracerOptions::Light::indirect : PathTracerOptions::Light::full;
  const Quiet quiet;  // the tracer's own progress bar would write over the report's
  Rendering out;
  std::vector<double> frames, builds, cpu_ms;
  if (task.frames > 1) path_trace(task.scene, task.camera, tracer);  // nothing but threads and caches to warm
  for (int f = 0; f < task.frames; ++f) {
    builds.push_back(time_ms([&] { const PathIntegrator built_alone(task.scene); }));
    const double before_ms = processor_ms();
    frames.push_back(time_ms([&] { out.picture = path_trace(task.scene, task.camera, tracer).color; }));
    cpu_ms.push_back(processor_ms() - before_ms);
  }
  const auto [smallest, largest] = std::minmax_element(frames.begin(), frames.end());
  out.min_ms = *smallest;
  out.median_ms = median(frames);
  out.max_ms = *largest;
  out.cpu_ms = median(cpu_ms);
  const double build_ms = std::min(median(builds), out.median_ms);
  out.passes.push_back({{"name", "reference/build"}, {"ms", build_ms}});
  out.passes.push_back({{"name", "reference/trace"}, {"ms", out.median_ms - build_ms}});
  out.timer = "wall";
  return out;
}

}  // namespace

void check_options(const std::string& renderer, const std::vector<std::string>& options) {
  if (renderer == "render") frame_options(options, "full", glm::ivec2(1));
  if (renderer == "reference") tracer_options(options);
}

std::vector<std::string> options_left_alone(const RenderTask& task) {
  const AskedFrame asked = frame_options(task.options, task.light, task.size);
  if (asked.by_quality || asked.command.automatic()) return {};
  screen::FrameOptions fitted = asked.options;
  const auto fit = asked.command.fit(task.scene, glm::vec3(task.camera.world_from_camera[3]), 0, fitted);
  std::vector<std::string> added;
  for (const std::string& value : screen::values_left_alone(fit.needs, asked.options)) {
    added.emplace_back("--set");
    added.push_back(value);
  }
  return added;
}

std::map<std::string, Renderer> standard_renderers() {
  return {{"render", render_frames}, {"reference", trace_paths}, {ADDED_PICTURE, read_added_picture}};
}

}  // namespace volgi::app
