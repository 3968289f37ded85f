#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdio>
#include <memory>

#include "apps/bench/against_path_tracing.h"
#include "apps/bench/cascades.h"
#include "apps/bench/cochran2007.h"
#include "apps/bench/conservative.h"
#include "apps/bench/dong2009.h"
#include "apps/bench/gpu.h"
#include "apps/bench/lattice.h"
#include "apps/bench/mpi.h"
#include "apps/bench/nichols2010.h"
#include "apps/bench/nichols2010_area.h"
#include "apps/bench/propagation.h"
#include "apps/bench/repeated_frame.h"
#include "apps/bench/split.h"
#include "apps/bench/voxelize.h"
#include "apps/bench/voxelize_gl.h"
#include "apps/report/machine.h"
#include "apps/volgi/commands.h"
#include "apps/volgi/device_options.h"
#include "apps/volgi/frame_stats.h"
#include "apps/volgi/program_ranks.h"
#include "apps/volgi/volume_options.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "core/gl/context.h"
#include "core/log.h"
#include "core/scene_source.h"
#include "propagation/light_in/direct_light_cpu.h"
#include "propagation/volume_cpu.h"
#include "screen/frame/frame.h"

namespace volgi::app {

namespace {

std::filesystem::path temporary_folder() {
  std::error_code none;  // then the current one
  return std::filesystem::temp_directory_path(none);
}

struct BenchCommand {
  std::vector<std::string> names;
  std::filesystem::path data = "data";
  std::filesystem::path generated = "build/release/data";
  std::filesystem::path cache = temporary_folder() / "volgi_references";
  std::vector<std::string> scenes;  // none: those that the benchmark speaks of
  int frames = 5;
  std::optional<int> size;  // none: each benchmark's own
  std::vector<int> curve_lights = Dong2009Options{}.curve_lights;
  int reference_spp = AgainstPathTracingOptions{}.reference_spp;
  int grid_cells = 32;
  int iterations = 64;
  bool json = false;
  DeviceOptions device;

  int largest_grid = 128;
  double budget_s = GpuBenchOptions{}.budget_s;
  bool quick = false;
  std::filesystem::path page;  // empty: none is written

  int run() const;
  void run_frames(nlohmann::json& results) const;
  void run_propagation(nlohmann::json& results) const;
  void run_cascades(nlohmann::json& results) const;
  void run_voxelize(nlohmann::json& results) const;
  void run_cochran2007(nlohmann::json& results) const;
  void run_dong2009(nlohmann::json& results) const;
  void run_nichols2010(nlohmann::json& results) const;
  void run_against_path_tracing(nlohmann::json& results) const;
  void run_split(nlohmann::json& results) const;
  void run_lattice(nlohmann::json& results) const;
  void run_nichols2010_area(nlohmann::json& results) const;
  void run_gpu(nlohmann::json& results) const;
  void run_mpi(nlohmann::json& results) const;
  std::string gpu_command() const;
  std::vector<std::string> scenes_or(const std::vector<std::string>& usual) const {
    return scenes.empty() ? usual : scenes;
  }
  void show(const std::string& table) const;
  Scene scene(const std::string& name) const;
  nlohmann::json bench_frame(const std::string& name, Scheme scheme, gl::Context& context) const;
};

/// `conservative` runs the requested number of passes, as the papers' tables have it; `ordinates` all bounces.
nlohmann::json BenchCommand::bench_frame(const std::string& name, Scheme scheme, gl::Context& context) const {
  const Scene scene = this->scene(name);
  screen::FrameOptions options;
  options.recipe = "volume";
  options.size = glm::ivec2(size.value_or(512));
  options.of<VolumeOptions>().grid_cells = grid_cells;
  options.of<VolumeOptions>().scheme.scheme = scheme;
  options.backend = screen::Backend::gpu;
  if (scheme == Scheme::conservative) options.of<VolumeOptions>().iterations = iterations;
  RepeatedFrame picture(scene, context, options);
  picture.render_repeatedly(frames);
  auto stats = frame_stats(scene.name, options.recipe, options.size, context, picture.timer(),
                           {frames, true, picture.cold()}, picture.frame().report());
  for (const auto& pass : stats["passes"]) {
    if (pass["name"] == "propagation/propagate")
      stats["iteration_ms"] = pass["gpu_ms"].get<double>() / stats["iterations"].get<double>();
  }
  return stats;
}

void BenchCommand::run_frames(nlohmann::json& results) const {
  gl::Context context(device.context);
  for (const std::string& name : scenes_or({"cornell", "atrium"})) {
    for (auto scheme : {Scheme::conservative, Scheme::ordinates}) {
      nlohmann::json r = bench_frame(name, scheme, context);
      r["scheme"] = scheme_name(scheme);
      if (!json) {
        fmt::print("{} {}x{}, {}, {} ({} timer)\n{}", name, r["size"][0].get<int>(), r["size"][1].get<int>(),
                   scheme_name(scheme), context.device_name(), r["timer"].get<std::string>(), pass_table(r));
        if (r.contains("iteration_ms"))
          fmt::print("  one pass over the volume {:.2f} ms\n", r["iteration_ms"].get<double>());
      }
      results["frame"].push_back(std::move(r));
    }
  }
}

// At once: the next may take long.
void BenchCommand::show(const std::string& table) const {
  if (json) return;
  fmt::print("{}", table);
  std::fflush(stdout);
}

Scene BenchCommand::scene(const std::string& name) const {
  if (name.starts_with(SceneSource::kBuiltInPrefix)) return load_scene(name);
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
  // The sun's light, as the paper's figure has it.
  const SideFlux sun = DirectLightCpu(atrium).flux(volume.voxels());
  r["sparse_over_dense"] = bench_sparse(volume.voxels(), sun.punctual, 16, frames);
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

void BenchCommand::run_cascades(nlohmann::json& results) const {
  set_quiet(true);
  for (const std::string& name : scenes_or({"street"})) {
    nlohmann::json result = bench_cascades(scene(name), CascadesBenchOptions{});
    show(cascades_table(result));
    results["cascades"].push_back(std::move(result));
  }
}

void BenchCommand::run_voxelize(nlohmann::json& results) const {
  const gl::Context context(device.context);
  for (const std::string& name : scenes_or({"atrium", "atrium_detail"})) {
    nlohmann::json& r = results["voxelize"].emplace_back(bench_voxelize(scene(name), largest_grid, frames));
    show(voxelize_table(r));
    nlohmann::json& gpu = results["voxelize_gpu"].emplace_back(bench_voxelize_gl(scene(name), largest_grid, frames));
    show(voxelize_gl_table(gpu));
  }
}

void BenchCommand::run_cochran2007(nlohmann::json& results) const {
  const gl::Context context(device.context);
  nlohmann::json& r = results["cochran2007"];
  r = bench_cochran2007(scene("bunny"), context, frames);
  if (!json) fmt::print("{}", cochran2007_table(r));
}

void BenchCommand::run_dong2009(nlohmann::json& results) const {
  const gl::Context context(device.context);
  Dong2009Options options;
  options.scenes = options.curve_scenes = scenes;
  options.size = size.value_or(options.size);
  options.curve_size = size.value_or(options.curve_size);
  options.frames = frames;
  options.curve_lights = curve_lights;
  options.one_bounce = data / "references" / "one_bounce";
  nlohmann::json& r = results["dong2009"];
  r = bench_dong2009([this](const std::string& name) { return scene(name); }, context, options,
                     [this](const std::string& table) { show(table); });
}

void BenchCommand::run_nichols2010(nlohmann::json& results) const {
  const gl::Context context(device.context);
  Nichols2010Options options;
  options.scenes = scenes;
  if (size) options.sizes = {*size};
  options.frames = std::min(frames, options.frames);
  options.quick = quick;
  results["nichols2010"] = bench_nichols2010([this](const std::string& name) { return scene(name); }, context, options,
                                             [this](const std::string& table) { show(table); });
}

void BenchCommand::run_against_path_tracing(nlohmann::json& results) const {
  const gl::Context context(device.context);
  AgainstPathTracingOptions options;
  options.size = size.value_or(options.size);
  options.frames = frames;
  options.reference_spp = reference_spp;
  options.cache = cache;
  for (const std::string& name : scenes_or({"cornell", "room", "atrium"})) {
    nlohmann::json r = bench_against_path_tracing(scene(name), context, options);
    show(against_path_tracing_table(r));
    results["against-path-tracing"].push_back(std::move(r));
  }
}

void BenchCommand::run_split(nlohmann::json& results) const {
  const gl::Context context(device.context);
  SplitOptions options;
  options.cache = cache;
  options.size = size.value_or(options.size);
  options.reference_spp = reference_spp;
  for (const std::string& name : scenes_or({"cornell", "room"})) {
    nlohmann::json result = bench_split(scene(name), context, options);
    show(split_table(result));
    results["split"].push_back(std::move(result));
  }
}

void BenchCommand::run_lattice(nlohmann::json& results) const {
  const gl::Context context(device.context);
  LatticeBenchOptions options;
  options.scenes = scenes;
  if (!scenes.empty()) options.swept = options.mapped = scenes.front();
  options.size = size.value_or(options.size);
  options.frames = frames;
  options.references = data / "references";
  results["lattice"] = bench_lattice([this](const std::string& name) { return scene(name); }, context, options,
                                     [this](const std::string& table) { show(table); });
}

void BenchCommand::run_nichols2010_area(nlohmann::json& results) const {
  const gl::Context context(device.context);
  NicholsAreaBenchOptions options;
  options.size = size.value_or(options.size);
  options.frames = frames;
  options.data = data;
  results["nichols2010_area"] =
      bench_nichols2010_area(context, options, [this](const std::string& table) { show(table); });
}

std::string BenchCommand::gpu_command() const {
  std::string text = fmt::format("volgi bench gpu --frames {} --budget {:g}", quick ? 1 : frames, budget_s);
  if (quick) text += " --quick";
  if (device.context.device) text += fmt::format(" --device {}", *device.context.device);
  return text;
}

void BenchCommand::run_gpu(nlohmann::json& results) const {
  if (!page.empty()) check_writable(page);  // not after minutes
  const gl::Context context(device.context);
  GpuBenchOptions options;
  options.frames = quick ? 1 : frames;
  options.budget_s = budget_s;
  options.quick = quick;
  options.references = data / "references";
  options.command = gpu_command();
  options.date = date_now();
  options.machine = machine_name();
  nlohmann::json& r = results["gpu"];
  r = bench_gpu([this](const std::string& name) { return scene(name); }, context, options,
                [this](const std::string& table) { show(table); });
  if (!page.empty()) write_text_atomically(page, gpu_page(r));
}

void BenchCommand::run_mpi(nlohmann::json& results) const {
  results["mpi"] = bench_mpi(program_ranks(), largest_grid, frames);
  if (is_first_rank()) show(mpi_table(results["mpi"]));
}

struct Benchmark {
  const char* name;
  void (BenchCommand::*run)(nlohmann::json&) const;
};
constexpr Benchmark kBenchmarks[] = {{"frame", &BenchCommand::run_frames},
                                     {"propagation", &BenchCommand::run_propagation},
                                     {"voxelize", &BenchCommand::run_voxelize},
                                     {"cascades", &BenchCommand::run_cascades},
                                     {"cochran2007", &BenchCommand::run_cochran2007},
                                     {"dong2009", &BenchCommand::run_dong2009},
                                     {"nichols2010", &BenchCommand::run_nichols2010},
                                     {"against-path-tracing", &BenchCommand::run_against_path_tracing},
                                     {"split", &BenchCommand::run_split},
                                     {"lattice", &BenchCommand::run_lattice},
                                     {"nichols2010_area", &BenchCommand::run_nichols2010_area},
                                     {"gpu", &BenchCommand::run_gpu},
                                     {"mpi", &BenchCommand::run_mpi}};

std::string benchmark_names() {
  std::vector<const char*> names;
  for (const Benchmark& benchmark : kBenchmarks) names.push_back(benchmark.name);
  return fmt::format("{}", fmt::join(names, ", "));
}

int BenchCommand::run() const {
  for (const std::string& name : names) {
    if (std::none_of(std::begin(kBenchmarks), std::end(kBenchmarks), [&](const auto& b) { return b.name == name; }))
      throw Error(ExitCode::usage, "no benchmark '" + name + "'; there are: " + benchmark_names());
  }
  const auto asked = [this](const char* name) {
    return names.empty() || std::find(names.begin(), names.end(), name) != names.end();
  };
  if (names != std::vector<std::string>{"mpi"}) refuse_several_ranks("bench");
  if (!page.empty() && !asked("gpu")) throw Error(ExitCode::usage, "-o is the page of the benchmark gpu: name it too");
  nlohmann::json results;
  for (const Benchmark& benchmark : kBenchmarks) {
    if (asked(benchmark.name)) (this->*benchmark.run)(results);
  }
  if (json && is_first_rank()) fmt::print("{}\n", results.dump(1));
  return int(ExitCode::done);
}

}  // namespace

void add_bench_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<BenchCommand>();
  CLI::App* command = app.add_subcommand(
      "bench",
      "times, medians: 'frame' renders cornell and atrium, pass by pass; 'propagation' and 'voxelize' "
      "time the CPU's volume against copying memory and OpenVDB; 'cochran2007', 'dong2009' and 'nichols2010' repeat "
      "those papers' tables and curves, 'nichols2010_area' that thesis' figures on area lights; 'lattice' measures the "
      "wave lattice and imperfect maps; 'cascades' holds nested grids against one; 'against-path-tracing' tells how "
      "long "
      "path tracing takes to the error of --gi hybrid, 'split' which of hybrid's terms its error is in; "
      "'gpu' measures this OpenGL device: every pass, the volume against copying, frame time against error; "
      "'mpi', under mpirun, measures sweeps over ranks beside what a model says of them");
  command->add_option("NAME", options->names, fmt::format("benchmarks to run: {} (all)", benchmark_names()));
  command->add_option("--data", options->data, "folder of cornell.glb")->capture_default_str();
  command->add_option("--generated", options->generated, "folder of atrium.glb")->capture_default_str();
  command->add_option("--frames", options->frames, "frames measured, after two warm-up frames")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command
      ->add_option("--size", options->size,
                   "pixels on each side [512; dong2009: 800, its curve, lattice and nichols2010_area 192; nichols2010: "
                   "512 and 1024]")
      ->check(CLI::Range(16, 8192));
  command
      ->add_option("--scene", options->scenes,
                   "scenes by name, of frame, cascades, dong2009, nichols2010, lattice, split and against-path-tracing "
                   "[their own]")
      ->type_name("NAME");
  command->add_option("--curve-vpls", options->curve_lights, "dong2009: numbers of virtual lights of its curve")
      ->check(CLI::Range(2, 65536))
      ->capture_default_str();
  command
      ->add_option("--reference-spp", options->reference_spp,
                   "samples of the references of against-path-tracing and split")
      ->check(CLI::Range(2, 1 << 24))
      ->capture_default_str();
  command
      ->add_option(
          "--cache", options->cache,
          "folder that keeps the references of against-path-tracing and split; empty it when the path tracer changes")
      ->capture_default_str();
  command->add_option("--grid", options->grid_cells, "cells along the longest axis")
      ->check(CLI::Range(1, VolumeOptions::kMaxDenseGridCells))
      ->capture_default_str();
  command->add_option("--largest-grid", options->largest_grid, "cells on an edge, for propagation, voxelize and mpi")
      ->check(CLI::Range(32, VolumeOptions::kMaxDenseGridCells))
      ->capture_default_str();
  command->add_option("--iterations", options->iterations, "passes over the volume")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  command
      ->add_option("--budget", options->budget_s,
                   "gpu: seconds that it may take, about; what does not fit is measured once, or skipped by name")
      ->check(CLI::Range(1.0, 1e5))
      ->capture_default_str();
  command->add_flag("--quick", options->quick,
                    "gpu, nichols2010: cornell alone, small, one frame; tries the benchmark, not the GPU");
  command->add_option("-o,--summary", options->page, "gpu: Markdown page to write")->type_name("FILE.md");
  options->device.add_to(*command);
  command->add_flag("--json", options->json, "print JSON");
  command->footer("Example: volgi bench frame --frames 5");
  command->callback([options, &exit_code] { exit_code = options->run(); });
}

}  // namespace volgi::app
