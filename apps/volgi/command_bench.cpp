#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "apps/volgi/commands.h"
#include "apps/volgi/frame_stats.h"
#include "core/error.h"
#include "core/gl/context.h"
#include "core/log.h"
#include "screen/frame.h"

namespace volgi::app {

namespace {

struct BenchCommand {
  std::vector<std::string> names;
  std::filesystem::path data = "data";
  std::filesystem::path generated = "build/release/data";
  int frames = 5;
  int size = 512;
  int grid_cells = 32;
  int iterations = 64;
  bool json = false;
  std::optional<int> device;

  int run() const;
  nlohmann::json bench_frame(const std::string& name, Scheme scheme, gl::Context& context) const;
};

/// `conservative` runs the number of passes asked for, as the papers' tables have it; `ordinates` all bounces.
nlohmann::json BenchCommand::bench_frame(const std::string& name, Scheme scheme, gl::Context& context) const {
  std::filesystem::path path = data / (name + ".glb");
  if (!std::filesystem::exists(path)) path = generated / (name + ".glb");
  Scene scene = load_scene(path);
  if (scene.cameras.empty()) throw Error(ExitCode::bad_input, path.string() + ": a benchmark scene needs a camera");
  screen::FrameOptions options;
  options.size = {size, size};
  options.volume.grid_cells = grid_cells;
  options.volume.scheme.scheme = scheme;
  if (scheme == Scheme::conservative) options.volume.iterations = iterations;
  screen::Frame frame(scene, options);
  gl::PassTimer timer(context.software(), true);
  constexpr int kWarmUp = 2;
  for (int f = 0; f < kWarmUp + frames; ++f) {
    if (f == kWarmUp) timer.reset();
    timer.begin_frame();
    frame.render(scene.cameras[0], timer);
    timer.end_frame();
  }
  auto stats = frame_stats(scene.name, "volume", options.size, context, timer, frames, frame.report());
  for (const auto& pass : stats["passes"]) {
    if (pass["name"] == "propagation/propagate")
      stats["iteration_ms"] = pass["gpu_ms"].get<double>() / stats["iterations"].get<double>();
  }
  return stats;
}

int BenchCommand::run() const {
  for (const std::string& name : names) {
    if (name != "frame") throw Error(ExitCode::usage, "no benchmark '" + name + "'; there is: frame");
  }
  gl::Context context(device);
  nlohmann::json results = nlohmann::json::array();
  for (const char* name : {"cornell", "atrium"}) {
    for (auto scheme : {Scheme::conservative, Scheme::ordinates}) {
      results.push_back(bench_frame(name, scheme, context));
      auto& r = results.back();
      r["scheme"] = scheme == Scheme::conservative ? "conservative" : "ordinates";
      if (json) continue;
      fmt::print("{} {}x{}, {}, {} ({} timer)\n{}", name, size, size, r["scheme"].get<std::string>(),
                 context.device_name(), r["timer"].get<std::string>(), pass_table(r));
      if (r.contains("iteration_ms"))
        fmt::print("  one pass over the volume {:.2f} ms\n", r["iteration_ms"].get<double>());
    }
  }
  if (json) fmt::print("{}\n", results.dump(1));
  return int(ExitCode::done);
}

}  // namespace

void add_bench_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<BenchCommand>();
  CLI::App* command = app.add_subcommand("bench", "times: 'frame' renders cornell and atrium, medians per pass");
  command->add_option("NAME", options->names, "benchmarks to run: frame (all)");
  command->add_option("--data", options->data, "folder of cornell.glb")->capture_default_str();
  command->add_option("--generated", options->generated, "folder of atrium.glb")->capture_default_str();
  command->add_option("--frames", options->frames, "frames measured, after two warm-up frames")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->add_option("--size", options->size, "pixels on each side")
      ->check(CLI::Range(16, 8192))
      ->capture_default_str();
  command->add_option("--grid", options->grid_cells, "cells along the longest axis")
      ->check(CLI::Range(1, VolumeOptions::kMostGridCells))
      ->capture_default_str();
  command->add_option("--iterations", options->iterations, "passes over the volume")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  command->add_option("--device", options->device, "number of the EGL device");
  command->add_flag("--json", options->json, "print JSON");
  command->footer("Example: volgi bench frame --frames 5");
  command->callback([options, &exit_code] { exit_code = options->run(); });
}

}  // namespace volgi::app
