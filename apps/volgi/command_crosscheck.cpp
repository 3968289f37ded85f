#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/volgi/commands.h"
#include "apps/volgi/device_options.h"
#include "apps/volgi/reading_options.h"
#include "apps/volgi/scene_options.h"
#include "apps/volgi/volume_options.h"
#include "core/error.h"
#include "core/gl/context.h"
#include "core/log.h"
#include "propagation/crosscheck.h"

namespace volgi::app {

namespace {

struct CrosscheckCommand {
  std::filesystem::path scene_path;
  ReadingOptions file;
  VolumeCommandOptions volume;
  std::vector<int> passes = {1, 8, 64};
  DeviceOptions device;
  bool json = false;

  int run() const;
};

nlohmann::json to_json(const CrosscheckRow& r) {
  return {{"stage", r.stage},
          {"scale", r.scale},
          {"compared", r.compared},
          {"maximum", r.maximum},
          {"percentile_99_9", r.percentile_999},
          {"worst_cell", {r.worst_cell.x, r.worst_cell.y, r.worst_cell.z}},
          {"limit", r.limit},
          {"passed", r.passed()}};
}

void print_table(const std::vector<CrosscheckRow>& rows) {
  fmt::print("{:<24} {:>10} {:>10} {:>10} {:>9}  {:<16} {}\n", "stage", "maximum", "99.9 %", "limit", "compared",
             "worst cell", "relative to");
  for (const CrosscheckRow& r : rows) {
    const std::string cell = fmt::format("{},{},{}", r.worst_cell.x, r.worst_cell.y, r.worst_cell.z);
    fmt::print("{:<24} {:>10.2e} {:>10.2e} {:>10.0e} {:>9}  {:<16} {}{}\n", r.stage, r.maximum, r.percentile_999,
               r.limit, r.compared, cell, r.scale, r.passed() ? "" : "  <- above the limit");
  }
}

int CrosscheckCommand::run() const {
  volume.limit_threads();
  const VolumeOptions options = volume.volume_options();
  refuse_on_gpu(options);
  const Scene scene = load_scene(scene_path, 0.0, file.reading);
  const gl::Context context(device.context);
  const std::vector<CrosscheckRow> rows = crosscheck(scene, options, passes);
  const bool passed = std::all_of(rows.begin(), rows.end(), [](const auto& r) { return r.passed(); });
  if (json) {
    nlohmann::json all = nlohmann::json::array();
    for (const CrosscheckRow& r : rows) all.push_back(to_json(r));
    fmt::print("{}\n", nlohmann::json{{"scene", scene.name},
                                      {"scheme", volume.scheme},
                                      {"device", context.device_name()},
                                      {"stages", all},
                                      {"passed", passed}}
                           .dump(1));
  } else {
    fmt::print("{}, {}, {} against the CPU\n", scene.name, volume.scheme, context.device_name());
    print_table(rows);
  }
  return int(passed ? ExitCode::done : ExitCode::comparison_failed);
}

}  // namespace

void add_crosscheck_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<CrosscheckCommand>();
  CLI::App* command = app.add_subcommand(
      "crosscheck", "compare the volume on the GPU with its CPU twin, stage by stage; 1 when they differ");
  command->add_option("SCENE", options->scene_path, scene_help)->required();
  options->file.add_to(*command);
  options->volume.add_to(*command);
  command->add_option("--passes", options->passes, "passes over the volume after which to compare")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  options->device.add_to(*command);
  command->add_flag("--json", options->json, "print JSON");
  command->footer("Example: volgi crosscheck data/cornell.glb --grid 32 --scheme ordinates");
  command->callback([options, &exit_code] { exit_code = options->run(); });
}

}  // namespace volgi::app
