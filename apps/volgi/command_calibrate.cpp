#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <memory>
#include <system_error>

#include "apps/report/front.h"
#include "apps/report/front_check.h"
#include "apps/report/points_file.h"
#include "apps/volgi/commands.h"
#include "apps/volgi/device_options.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "core/log.h"

namespace volgi::app {

namespace {

namespace fs = std::filesystem;

struct CalibrateCommand {
  fs::path scene, output, report, data = "data";
  DeviceOptions device;
  bool quiet = false, leave_one_out = false;

  int run() const;

 private:
  int collect() const;
  fs::path scene_path() const;
};

/// The Cornell box: beside the program's source or build, or where it was installed.
fs::path CalibrateCommand::scene_path() const {
  if (!scene.empty()) return scene;
  std::error_code error;
  const fs::path folder = fs::read_symlink("/proc/self/exe", error).parent_path();
  for (const fs::path& place : {folder / "../../../data/cornell.glb", folder / "../share/volgi/cornell.glb"}) {
    if (fs::is_regular_file(place, error)) return fs::weakly_canonical(place, error);
  }
  throw Error(ExitCode::bad_input, "cornell.glb: not beside the program; --scene FILE");
}

int CalibrateCommand::collect() const {
  if (output.empty()) throw Error(ExitCode::usage, "--report: where to? -o FILE");
  const fs::path file = report / "points.jsonl";
  if (!fs::is_regular_file(file)) throw Error(ExitCode::bad_input, file.string() + ": not there");
  check_writable(output);
  const screen::MeasuredFront front = front_of_points(PointsFile(file).points(), data);
  write_text_atomically(output, to_json(front).dump(1) + '\n');
  if (!quiet)
    fmt::print("wrote {}: {} settings on {} scenes, {}\n", output.string(), front.settings.size(), front.scenes.size(),
               front.device);
  return int(ExitCode::done);
}

int CalibrateCommand::run() const {
  set_quiet(quiet);
  if (leave_one_out) {
    const std::vector<FrontCheck> checks = app::leave_one_out(shipped_front(), usual_budgets());
    const auto kept = std::count_if(checks.begin(), checks.end(), keeps_budget);
    fmt::print("{}\nkept: {} of {}\n", check_table(checks), kept, checks.size());
    return int(ExitCode::done);
  }
  if (!report.empty()) return collect();
  const fs::path from = scene_path();
  gl::Context context(device.context);
  const fs::path file = output.empty() ? device_times_path(context.device_name()) : output;
  if (file.empty())
    throw Error(ExitCode::cannot_write, "no folder for data: neither XDG_DATA_HOME nor HOME is set; -o FILE");
  const screen::MeasuredFront& front = shipped_front();
  const DeviceTimes times = measure_device(front, from, context);
  write_device_times(file, times);
  if (quiet) return int(ExitCode::done);
  const screen::DeviceFactors factors = factors_of(times, front);
  fmt::print("device: {}\n{:<44} {:>10} {:>10}\n", times.device, "setting", "ms", "of shipped");
  for (size_t s = 0; s < times.times.size(); ++s)
    fmt::print("{:<44} {:10.1f} {:10.2f}\n", times.times[s].setting, times.times[s].ms, factors.small[s]);
  fmt::print("wrote {}\n", file.string());
  return int(ExitCode::done);
}

}  // namespace

void add_calibrate_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<CalibrateCommand>();
  CLI::App* command = app.add_subcommand("calibrate", "measure what this device takes, for --gi auto; about a minute");
  command->add_option("-o,--output", options->output,
                      "file of times (volgi/times/DEVICE.json below $XDG_DATA_HOME, where --gi auto looks for it)");
  command->add_option("--scene", options->scene, "scene that is measured, one of the front's (the Cornell box)")
      ->type_name("FILE");
  command
      ->add_option("--report", options->report,
                   "measures nothing: the front itself, of the points of a report by data/report/auto.json, to -o")
      ->type_name("DIR");
  command->add_flag("--leave-one-out", options->leave_one_out,
                    "measures nothing: what the front would choose for each of its scenes by the others, as Markdown");
  command->add_option("--data", options->data, "folder with scenes.json, for --report")->capture_default_str();
  options->device.add_to(*command);
  command->add_flag("--quiet", options->quiet, "print nothing but errors");
  command->footer(
      "Errors are those of the front that is part of the program; times are this device's.\n"
      "Example: volgi calibrate\n"
      "         volgi render data/room.glb -o out/room.png --gi auto --budget 50ms");
  command->callback([options, &exit_code] { exit_code = options->run(); });
}

}  // namespace volgi::app
