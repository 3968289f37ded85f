#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>

#include "apps/volgi/bench_cochran2007.h"
#include "apps/volgi/bench_conservative.h"
#include "apps/volgi/bench_propagation.h"
#include "apps/volgi/bench_voxelize.h"
#include "apps/volgi/commands.h"
#include "apps/volgi/frame_stats.h"
#include "apps/volgi/volume_options.h"
#include "core/error.h"
#include "core/gl/context.h"
#include "core/log.h"
#include "propagation/volume_cpu.h"
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

  int largest_grid = 128;

  int run() const;
  int run_frames(nlohmann::json& results) const;
  void run_propagation(nlohmann::json& results) const;
  void run_voxelize(nlohmann::json& results) const;
  void run_cochran2007(nlohmann::json& results) const;
  Scene scene(const std::string& name) const;
  nlohmann::json bench_frame(const std::string& name, Scheme scheme, gl::Context& context) const;
};

/// `conservative` runs the number of passes asked for, as the papers' tables have it; `ordinates` all bounces.
nlohmann::json BenchCommand::bench_frame(const std::string& name, Scheme scheme, gl::Context& context) const {
  const Scene scene = this->scene(name);
  if (scene.cameras.empty())
    throw Error(ExitCode::bad_input, scene.path.string() + ": a benchmark scene needs a camera");
  screen::FrameOptions options;
  options.size = {size, size};
  options.volume.grid_cells = grid_cells;
  options.volume.scheme.scheme = scheme;
  options.backend = screen::Backend::gpu;
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

int BenchCommand::run_frames(nlohmann::json& results) const {
  gl::Context context(device);
  for (const char* name : {"cornell", "atrium"}) {
    for (auto scheme : {Scheme::conservative, Scheme::ordinates}) {
      nlohmann::json r = bench_frame(name, scheme, context);
      r["scheme"] = scheme_name(scheme);
      if (!json) {
        fmt::print("{} {}x{}, {}, {} ({} timer)\n{}", name, size, size, scheme_name(scheme), context.device_name(),
                   r["timer"].get<std::string>(), pass_table(r));
        if (r.contains("iteration_ms"))
          fmt::print("  one pass over the volume {:.2f} ms\n", r["iteration_ms"].get<double>());
      }
      results["frame"].push_back(std::move(r));
    }
  }
  return int(ExitCode::done);
}

Scene BenchCommand::scene(const std::string& name) const {
  std::filesystem::path path = data / (name + ".glb");
  if (!std::filesystem::exists(path)) path = generated / (name + ".glb");
  return load_scene(path);
}

void BenchCommand::run_propagation(nlohmann::json& results) const {
  nlohmann::json& r = results["propagation"];
  set_quiet(true);  // no word about how long a benchmark takes
  r = bench_propagation(largest_grid, frames);
  r["conservative_over_copy"] = bench_conservative(largest_grid, 16, frames);
  const Scene atrium = scene("atrium");
  VolumeOptions lit;
  lit.grid_cells = largest_grid;
  VolumeCpu volume(atrium, lit);
  volume.voxelize();
  volume.light_in();  // the sun's light, as the paper's figure has it
  r["sparse_over_dense"] = bench_sparse(volume.voxels(), volume.flux().punctual, 16);
  if (json) return;
  fmt::print("{}", propagation_table(r));
  const auto& copy = r["conservative_over_copy"];
  fmt::print("conservative {}^3 dense: {:.1f} ms a pass, copy of the same bytes {:.1f} ms: ratio {:.2f}\n",
             largest_grid, copy["ms_per_iteration"].get<double>(), copy["copy_ms"].get<double>(),
             copy["ratio"].get<double>());
  const auto& sparse = r["sparse_over_dense"];
  fmt::print("conservative atrium, first 16 passes: sparse {:.2f} ms a pass, dense {:.2f}: {:.1f} times faster\n",
             sparse["sparse_ms"].get<double>(), sparse["dense_ms"].get<double>(), sparse["speedup"].get<double>());
}

void BenchCommand::run_voxelize(nlohmann::json& results) const {
  nlohmann::json& r = results["voxelize"];
  r = bench_voxelize(scene("atrium"), largest_grid, frames);
  if (json) return;
  fmt::print("{} ({} triangles) at {}^3: sides {:.1f} ms, cells {:.1f} ms, meshToVolume {:.1f} ms: {:.1f} times\n",
             r["scene"].get<std::string>(), r["triangles"].get<size_t>(), largest_grid, r["sides_ms"].get<double>(),
             r["cells_ms"].get<double>(), r["mesh_to_volume_ms"].get<double>(), r["ratio"].get<double>());
}

void BenchCommand::run_cochran2007(nlohmann::json& results) const {
  const gl::Context context(device);
  nlohmann::json& r = results["cochran2007"];
  r = bench_cochran2007(scene("bunny"), context, frames);
  if (!json) fmt::print("{}", cochran2007_table(r));
}

int BenchCommand::run() const {
  const std::vector<std::string> all = {"frame", "propagation", "voxelize", "cochran2007"};
  for (const std::string& name : names) {
    if (std::find(all.begin(), all.end(), name) == all.end())
      throw Error(ExitCode::usage,
                  "no benchmark '" + name + "'; there are: " + fmt::format("{}", fmt::join(all, ", ")));
  }
  const auto wanted = [&](const char* name) {
    return names.empty() || std::find(names.begin(), names.end(), name) != names.end();
  };
  nlohmann::json results;
  if (wanted("frame")) run_frames(results);
  if (wanted("propagation")) run_propagation(results);
  if (wanted("voxelize")) run_voxelize(results);
  if (wanted("cochran2007")) run_cochran2007(results);
  if (json) fmt::print("{}\n", results.dump(1));
  return int(ExitCode::done);
}

}  // namespace

void add_bench_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<BenchCommand>();
  CLI::App* command = app.add_subcommand(
      "bench",
      "times, medians: 'frame' renders cornell and atrium, pass by pass; 'propagation' and 'voxelize' "
      "time the CPU's volume against copying memory and OpenVDB; 'cochran2007' repeats that paper's tables");
  command->add_option("NAME", options->names, "benchmarks to run: frame, propagation, voxelize, cochran2007 (all)");
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
  command->add_option("--largest-grid", options->largest_grid, "cells on an edge, for propagation and voxelize")
      ->check(CLI::Range(32, VolumeOptions::kMostGridCells))
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
