#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "apps/volgi/commands.h"
#include "apps/volgi/metrics_json.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "core/image.h"
#include "core/log.h"
#include "reference/error_map.h"
#include "reference/fit_hint.h"
#include "reference/flip.h"
#include "reference/metrics.h"
#include "reference/picture_files.h"

namespace volgi::app {
namespace {

using AskedLight = PathTracerOptions::Light;

struct CompareOptions {
  std::filesystem::path reference;
  std::vector<std::filesystem::path> tests;
  std::optional<std::string> region;  // noedge where the reference has the layers for it
  std::string light = "full";
  bool json = false;
  std::filesystem::path diff;
  std::optional<double> max_rmse_percent, max_p95_percent, max_blk_percent, max_absolute;
  std::optional<std::string> energy;

  bool any_limit() const { return max_rmse_percent || max_p95_percent || max_blk_percent || max_absolute || energy; }
};

struct Range {
  double low, high;
};

Range parse_range(const std::string& text) {
  try {
    size_t low_end = 0, high_end = 0;
    const double low = std::stod(text, &low_end);
    if (low_end < text.size() && text[low_end] == ':') {
      const std::string rest = text.substr(low_end + 1);
      const double high = std::stod(rest, &high_end);
      if (high_end == rest.size() && low <= high) return {low, high};
    }
  } catch (const std::exception&) {  // falls through to the one message
  }
  throw Error(ExitCode::usage, fmt::format("--energy {} is not LOW:HIGH, such as 0.98:1.02", text));
}

AskedLight light_from_name(const std::string& name) {
  if (name == "direct") return AskedLight::direct;
  return name == "indirect" ? AskedLight::indirect : AskedLight::full;
}

Region requested_region(const CompareOptions& options, const ReferenceFile& reference) {
  const Region region = *region_from_name(options.region.value_or("noedge"));
  if (reference.layers || region == Region::all) return region;
  if (options.region)
    throw Error(ExitCode::usage,
                fmt::format("--region {} needs position, normal, id and direct layers, which {} does not "
                            "have: use --region all",
                            *options.region, options.reference.string()));
  warn_once(fmt::format("{} has no auxiliary layers: every pixel is compared", options.reference.string()));
  return Region::all;
}

// A limit is broken by a figure above it, and by one that does not exist.
void check_limit(std::vector<std::string>& broken, const char* name, std::optional<double> limit,
                 std::optional<double> value) {
  if (!limit) return;
  if (!value || !std::isfinite(*value))
    broken.push_back(fmt::format("{}: no figure", name));
  else if (*value > *limit)
    broken.push_back(fmt::format("{}: {:.6g} is over {:.6g}", name, *value, *limit));
}

std::vector<std::string> broken_limits(const CompareOptions& options, const Metrics& m) {
  std::vector<std::string> broken;
  if (!options.any_limit()) return broken;
  if (m.nonfinite > 0) broken.push_back(fmt::format("{} pixels are NaN or infinite", m.nonfinite));
  if (m.pixels == 0) return broken.push_back("no pixel in the region"), broken;
  check_limit(broken, "--max-absolute", options.max_absolute, m.max_absolute);
  if (!m.relative) {
    const bool percentages =
        options.max_rmse_percent || options.max_p95_percent || options.max_blk_percent || options.energy;
    if (percentages && m.max_absolute > 0)
      broken.push_back("the reference is black there and the picture is not: only --max-absolute can judge it");
    return broken;
  }
  const Metrics::Relative& r = *m.relative;
  check_limit(broken, "--max-rmse-percent", options.max_rmse_percent,
              r.rmse_pct_denoised ? *r.rmse_pct_denoised : r.rmse_pct);
  check_limit(broken, "--max-p95-percent", options.max_p95_percent, r.p95_percent);
  check_limit(broken, "--max-blk-percent", options.max_blk_percent, r.blk_pct);
  if (options.energy) {
    const Range range = parse_range(*options.energy);
    if (!(r.ratio >= range.low && r.ratio <= range.high))
      broken.push_back(fmt::format("--energy: {:.6g} is outside {}", r.ratio, *options.energy));
  }
  return broken;
}

std::string cell(const std::optional<double>& value, int decimals) {
  return value ? fmt::format("{:.{}f}", *value, decimals) : "-";
}

std::string table_head() {
  return fmt::format("{:>8} {:>8} {:>8} {:>9} {:>9} {:>7} {:>7} {:>8} {:>8} {:>7} {:>7} {:>10}  {}\n", "ratio", "rmse%",
                     "rmse%*", "relMSE", "relMSE*", "p95%", "blk%", "blkmax%", "scale", "ssim", "flip", "max|t-r|",
                     "picture");
}

std::string table_row(const Metrics& m, const std::optional<double>& flip, const std::string& name) {
  std::string row;
  if (m.pixels == 0)
    row = fmt::format("no pixel in the region  {}", name);
  else if (!m.relative)
    row = fmt::format("reference mean 0: test mean {:.4g}, |t-r| mean {:.4g}, max {:.4g}  {}", m.test_mean,
                      m.mean_absolute, m.max_absolute, name);
  else {
    const Metrics::Relative& r = *m.relative;
    row = fmt::format(
        "{:>8.4f} {:>8.2f} {:>8} {:>9.5f} {:>9} {:>7.2f} {:>7} {:>8} {:>8.4f} {:>7.4f} {:>7} {:>10.4g}  {}", r.ratio,
        r.rmse_pct, cell(r.rmse_pct_denoised, 2), r.relmse, cell(r.relmse_denoised, 5), r.p95_percent,
        cell(r.blk_pct, 2), cell(r.blkmax_pct, 2), r.scale, r.ssim, cell(flip, 4), m.max_absolute, name);
  }
  if (m.nonfinite + m.negative > 0) row += fmt::format("  [{} not finite, {} negative]", m.nonfinite, m.negative);
  return row + "\n";
}

// Where the map of a test goes: --diff itself, or for several tests a file of the test's name in that folder.
std::filesystem::path map_path(const CompareOptions& options, const std::filesystem::path& test) {
  return options.tests.size() == 1 ? options.diff : options.diff / (test.stem().string() + ".png");
}

void check_maps(const CompareOptions& options) {
  if (options.diff.empty()) return;
  std::set<std::filesystem::path> maps;
  for (const std::filesystem::path& test : options.tests) {
    if (!maps.insert(map_path(options, test)).second)
      throw Error(ExitCode::usage,
                  fmt::format("--diff {}: two pictures are called {}, and their maps would be one file",
                              options.diff.string(), test.stem().string()));
  }
  if (options.tests.size() > 1) {
    std::error_code error;
    std::filesystem::create_directories(options.diff, error);
    if (error)
      throw Error(ExitCode::cannot_write,
                  fmt::format("--diff {}: cannot make this folder for the maps of {} pictures: {}",
                              options.diff.string(), options.tests.size(), error.message()));
  }
  for (const std::filesystem::path& map : maps) check_writable(map);
}

/// The reference as it is compared with one picture: where both are.
struct Compared {
  ReferenceFile reference;
  TestPicture test;
};

Compared compared(const std::filesystem::path& path, const CompareOptions& options, const ReferenceFile& reference) {
  try {
    Compared both{reference, read_test(path, light_from_name(options.light))};
    crop_to_common(both.reference, both.test);
    both.test.color = box_downsample(both.test.color, both.reference.color.width, both.reference.color.height);
    return both;
  } catch (const Error& error) {
    if (std::string(error.what()).find(path.string()) != std::string::npos) throw;
    throw Error(error.code(), fmt::format("{}: {}", path.string(), error.what()));
  }
}

/// FLIP's mean over the region; nothing where the reference is black, or a region is empty.
std::optional<double> flip_mean(const Compared& both, const Mask& mask) {
  if (std::none_of(mask.begin(), mask.end(), [](auto m) { return m != 0; })) return std::nullopt;
  if (both.reference.for_screen && both.test.for_screen)
    return flip_ldr(both.reference.color, both.test.color).mean(mask);
  const std::optional<FlipMap> map = flip_hdr(both.reference.color, both.test.color);
  return map ? std::optional<double>(map->mean(mask)) : std::nullopt;
}

void warn_of_screens(const Compared& both, const std::filesystem::path& path) {
  if (both.reference.for_screen == both.test.for_screen) return;
  warn_once(fmt::format("{}: a PNG against an EXR, which is not tone mapped: for a look alone", path.string()));
}

int compare(const CompareOptions& options) {
  if (options.energy) parse_range(*options.energy);
  check_maps(options);
  const ReferenceFile whole = read_reference(options.reference, light_from_name(options.light));
  const Region region = requested_region(options, whole);
  nlohmann::ordered_json results = nlohmann::ordered_json::array();
  std::string table, failures;
  for (const std::filesystem::path& path : options.tests) {
    const Compared both = compared(path, options, whole);
    const ReferenceFile& reference = both.reference;
    const Image& test = both.test.color;
    const Mask everywhere(reference.color.pixels.size(), 1);
    const Mask mask = reference.layers ? region_mask(region, *reference.layers) : everywhere;
    const Mask hit = reference.layers ? region_mask(Region::hit, *reference.layers) : everywhere;
    warn_of_screens(both, path);
    const std::optional<double> flip = flip_mean(both, mask);
    const Metrics m = measure(reference.color, test, reference.noise ? &*reference.noise : nullptr, mask);
    const std::vector<std::string> broken = broken_limits(options, m);
    for (const std::string& limit : broken) failures += fmt::format("volgi compare: {}: {}\n", path.string(), limit);
    nlohmann::ordered_json json{{"reference", options.reference.string()}, {"test", path.string()}};
    json["light"] = options.light;
    json["region"] = std::string(name(region));
    json.update(to_json(m));
    if (flip) json["flip"] = *flip;
    json["failed"] = broken;
    table += table_row(m, flip, path.string());
    if (const std::string_view change = fit_hint(reference.color, test, hit); !change.empty()) {
      json["hint"] = std::string(change);
      table += fmt::format("   hint: the picture fits much better when {}\n", change);
    }
    results.push_back(json);
    if (!options.diff.empty()) write_png_display(map_path(options, path), error_map(reference.color, test, mask));
  }
  if (options.json)
    std::cout << results.dump(1) << '\n';
  else
    std::cout << fmt::format("light {}, region {}, reference {}\n", options.light, name(region),
                             options.reference.string())
              << table_head() << table;
  std::cerr << failures;
  return static_cast<int>(failures.empty() ? ExitCode::done : ExitCode::comparison_failed);
}

constexpr const char* kFooter =
    R"(Figures: ratio mean(test)/mean(ref); rmse% of mean(ref); relMSE; p95% 95th percentile of the relative error;
blk% RMS error of 16x16 block means; flip what an eye tells apart, 0 to 1 (HDR-FLIP of EXRs, LDR-FLIP of PNGs, 67 pixels a
degree); * with the reference's own noise taken out. A REF is an EXR of `volgi reference`,
or DIR/full.exr with full_noise.exr, direct.exr and aov.exr beside it, or a PNG. Crops are compared where both are. Exit code 1 when a limit is broken, or a limit is
given and a pixel is not finite; 3 when a pixel of REF is not.
Regions: all; hit, where geometry is seen; noedge, hit without edges of geometry or of shadows; of noedge, shadow has no
direct light and lit has, and no punctual light reaches shade.
Example: volgi compare data/reference/ref/cornell/full.exr mine.exr --max-blk-percent 2 --energy 0.99:1.01)";

}  // namespace

void add_compare_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<CompareOptions>();
  CLI::App& command = *app.add_subcommand("compare", "How far pictures are from a reference");
  command.add_option("REF", options->reference, "reference EXR")->required();
  command.add_option("TEST", options->tests, "EXR pictures of REF's size or an integer multiple of it")->required();
  command.add_option("--region", options->region, "pixels that count [noedge]")
      ->check(CLI::IsMember({"all", "hit", "noedge", "shadow", "lit", "shade"}));
  command
      .add_option("--light", options->light,
                  "light that is compared; a TEST without direct layer is that light already")
      ->check(CLI::IsMember({"full", "direct", "indirect"}))
      ->capture_default_str();
  command.add_flag("--json", options->json, "print an array of objects instead of a table");
  command.add_option(
      "--diff", options->diff,
      "write a map of the signed relative error with its colour bar, saturated at 50 %; a PNG file, or for "
      "several TESTs a folder of them");
  command.add_option("--max-rmse-percent", options->max_rmse_percent,
                     "limit on the noise-removed rmse [% of the mean]");
  command.add_option("--max-p95-percent", options->max_p95_percent,
                     "limit on the 95th percentile of the relative error [%]");
  command.add_option("--max-blk-percent", options->max_blk_percent, "limit on the error of 16x16 block means [%]");
  command.add_option("--max-absolute", options->max_absolute, "limit on the largest |test - ref| [W m^-2 sr^-1]");
  command.add_option("--energy", options->energy, "limits LOW:HIGH on mean(test)/mean(ref)");
  command.footer(kFooter);
  command.callback([options, &exit_code] { exit_code = compare(*options); });
}

}  // namespace volgi::app
