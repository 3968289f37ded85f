#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "apps/report/added_picture.h"
#include "apps/report/collect.h"
#include "apps/report/export.h"
#include "apps/report/page.h"
#include "apps/report/summary.h"
#include "apps/report/texts.h"
#include "apps/volgi/commands.h"
#include "apps/volgi/device_options.h"
#include "apps/volgi/light_options.h"
#include "apps/volgi/scene_options.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "core/log.h"

namespace volgi::app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct ReportOptions {
  std::vector<std::string> scenes, techniques, pictures;
  fs::path output, data = "data", sweep_file, summary;
  std::string size;
  std::optional<int> frames;
  DeviceOptions device;
  LightOptions lights;
  int repeat = 0;
  bool quick = false, page_only = false, quiet = false;
};

Sweep requested_sweep(const ReportOptions& options) {
  const std::string name = options.quick ? "quick.json" : "full.json";
  Sweep sweep;
  if (options.sweep_file.empty()) {
    sweep = parse_sweep(report_text(name), name);
  } else {
    std::ifstream file(options.sweep_file);
    if (!file) throw Error(ExitCode::bad_input, options.sweep_file.string() + ": cannot read this file");
    sweep = parse_sweep(std::string(std::istreambuf_iterator<char>(file), {}), options.sweep_file.string());
  }
  if (!options.scenes.empty()) sweep.scenes = options.scenes;
  if (!options.size.empty()) sweep.size = options.size;
  if (options.frames) sweep.frames = *options.frames;
  for (const std::string& technique : options.techniques) {
    const auto named = [&](const Setting& s) { return s.technique == technique; };
    if (std::none_of(sweep.settings.begin(), sweep.settings.end(), named)) {
      std::set<std::string> known;
      for (const Setting& s : sweep.settings) known.insert(s.technique);
      throw Error(ExitCode::usage, fmt::format("--technique {}: there are {}", technique, fmt::join(known, ", ")));
    }
  }
  std::erase_if(sweep.settings, [&](const Setting& s) {
    return !options.techniques.empty() &&
           std::find(options.techniques.begin(), options.techniques.end(), s.technique) == options.techniques.end();
  });
  return sweep;
}

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw Error(ExitCode::cannot_write, folder.string() + ": cannot make this folder: " + error.message());
}

// The last measurement of every scene, setting and light, whatever device and program it is of.
std::vector<Json> stored_points(const PointsFile& file) {
  std::vector<Json> out;
  for (Json& point : file.points()) {
    const auto same = [&](const Json& other) {
      for (const char* key : {"scene", "technique", "varied", "light"}) {
        if (other.at(key) != point.at(key)) return false;
      }
      return true;
    };
    const auto earlier = std::find_if(out.begin(), out.end(), same);
    if (earlier == out.end())
      out.push_back(std::move(point));
    else
      *earlier = std::move(point);
  }
  return out;
}

int print_repeated(const Repeated& repeated) {
  fmt::print(
      "{} points measured again: {} with the same figures to the last digit, {} with a time in the stated spread\n",
      repeated.points, repeated.points - int(repeated.different.size()), repeated.in_spread);
  if (repeated.points > 0) {
    const auto [smallest, largest] = std::minmax_element(repeated.times_as_long.begin(), repeated.times_as_long.end());
    fmt::print("times: {:.2f} to {:.2f} of those stated\n", *smallest, *largest);
  }
  for (const std::string& text : repeated.different) fmt::print(stderr, "volgi report: {}\n", text);
  return int(repeated.different.empty() ? ExitCode::done : ExitCode::comparison_failed);
}

void write_report(const Report& report, const ReportOptions& options) {
  write_csv(report, options.output / "report.csv");
  write_json(report, options.output / "report.json");
  write_text_atomically(options.output / "index.html", report_page(report, options.output));
  if (!options.summary.empty()) write_summary(report, options.output, options.summary);
  if (options.quiet) return;
  for (const Verdict& v : report.verdicts) {
    fmt::print("{}, {} light\n", v.scene, v.light);
    for (const Sentence& s : sentences(v)) fmt::print("  {}{}\n", s.warning ? "! " : "", s.text);
  }
  fmt::print("wrote {}\n", (options.output / "index.html").string());
}

int run(const ReportOptions& options, const std::string& command) {
  set_quiet(options.quiet);
  Sweep sweep = requested_sweep(options);
  std::vector<AddedPicture> pictures;
  for (const std::string& text : options.pictures) pictures.push_back(parse_added_picture(text));
  SceneOptions asked;
  asked.size_text = sweep.size;
  const glm::ivec2 size = asked.size();
  AddedLight added{options.lights.arguments(), [&](Scene& scene) { options.lights.apply(scene); }, {}};
  for (const fs::path& file : {fs::path(options.lights.sky), options.lights.lights}) {
    if (fs::is_regular_file(file)) added.files.push_back(file);
  }
  std::vector<ReportScene> scenes;
  if (!options.page_only) {
    for (const std::string& scene : sweep.scenes) scenes.push_back(open_report_scene(scene, options.data, size, added));
  } else if (!fs::exists(options.output / "points.jsonl")) {
    throw Error(ExitCode::bad_input,
                (options.output / "points.jsonl").string() + ": not there; measure without --page-only");
  }
  for (const AddedPicture& picture : pictures) {
    const std::vector<Setting> settings = settings_of(picture, scenes, size);
    sweep.settings.insert(sweep.settings.end(), settings.begin(), settings.end());
  }
  make_folder(options.output);
  if (!options.summary.empty()) check_writable(options.summary);  // not after an hour of measuring
  PointsFile file(options.output / "points.jsonl");
  if (options.page_only) {
    std::vector<Json> points = stored_points(file);
    if (points.empty())
      throw Error(ExitCode::bad_input, (options.output / "points.jsonl").string() + ": no points to show");
    write_report(Report(command, std::move(points)), options);
    return int(ExitCode::done);
  }
  gl::Context gl(options.device.context);
  const MeasureContext context{gl, standard_renderers(), options.output, size, sweep.frames};
  if (options.repeat > 0) return print_repeated(repeat_points(scenes, sweep, context, file, options.repeat));
  write_report(Report(command, collect_points(scenes, sweep, context, file)), options);
  return int(ExitCode::done);
}

constexpr const char* kFooter =
    R"(Writes DIR/index.html, one file that opens from disk: plots, verdicts, pictures, tables; beside it report.csv,
report.json, pictures/ and points.jsonl, a line a point. An interrupted report goes on where it was: a point is known by
scene content, technique, options, light, size, frames, device, machine and program, and measured once.
The same command started again meanwhile shares the work, here or on another machine of the same kind; where times
matter, one a machine (docs/batches.md). Techniques and
their sweeps are listed in data/report/full.json and quick.json, which are built into the program.
SCENE is a name from data/scenes.json or a glTF file; without a stored reference of that size one is traced first.
--quick: cornell, room, thin_wall and atrium, under three minutes on two cores.
Example: volgi report --quick -o out/report
         volgi report data/cornell.glb -o out/report --technique hybrid --technique "path tracer")";

void add_options(CLI::App& command, ReportOptions& o) {
  command.add_option("SCENE", o.scenes, "scenes [those the sweep lists]");
  command.add_option("-o,--output", o.output, "folder of the report; an earlier one is continued")->required();
  command.add_flag("--quick", o.quick, "the short sweep");
  command.add_option("--sweep", o.sweep_file, "another table of techniques, as data/report/full.json")
      ->type_name("FILE")
      ->excludes("--quick");
  command.add_option("--technique", o.techniques, "only this one of the table (again for more)")
      ->type_name("NAME")
      ->allow_extra_args(false);
  command.add_option("--size", o.size, "picture size in pixels [that of the sweep, 192x192]")->type_name("WxH");
  command.add_option("--frames", o.frames, "timed frames a point, after two warm-up frames [that of the sweep]")
      ->check(CLI::Range(1, 100000));
  command.add_option("--data", o.data, "folder with scenes.json and the stored references")->capture_default_str();
  o.device.add_to(command);
  o.lights.add_to(command);
  command.add_option("--summary", o.summary, "also a Markdown summary, with a folder of pictures beside it")
      ->type_name("FILE.md");
  command
      .add_option("--repeat", o.repeat,
                  "measure so many finished points again and compare; exit code 1 where one's "
                  "figures differ")
      ->check(CLI::Range(1, 1000000));
  command.add_flag("--page-only", o.page_only, "measure nothing: the page of what points.jsonl has");
  command
      .add_option(
          "--add-picture", o.pictures,
          "another renderer's picture of the scene beside ours, and the milliseconds that it took; {scene} and "
          "{light} in FILE stand for a scene's name and for full or indirect (docs/yardstick.md); may be repeated")
      ->type_name("NAME=FILE.exr[:MS]")
      ->allow_extra_args(false)
      ->excludes("--page-only");
  command.add_flag("--quiet", o.quiet, "print nothing but errors");
  command.footer(kFooter);
}

}  // namespace

void add_report_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<ReportOptions>();
  CLI::App& command =
      *app.add_subcommand("report", "speed against error of every technique, as one page that opens from disk");
  add_options(command, *options);
  command.callback([options, &exit_code] {
    std::ifstream file("/proc/self/cmdline", std::ios::binary);
    std::string line = "volgi", word;
    for (std::getline(file, word, '\0'); std::getline(file, word, '\0');)
      line += word.find(' ') == std::string::npos ? " " + word : " \"" + word + "\"";
    exit_code = run(*options, line);
  });
}

}  // namespace volgi::app
