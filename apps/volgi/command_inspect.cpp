#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/inspect/volume_page.h"
#include "apps/volgi/commands.h"
#include "apps/volgi/in_a_child.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "core/image.h"
#include "voxel/slice_picture.h"
#include "voxel/vdb_file.h"
#include "voxel/vdb_summary.h"

namespace volgi::app {

namespace {

using Json = nlohmann::ordered_json;

struct InspectCommand {
  std::filesystem::path file;
  std::string grid, slice, at;  // NAME, AXIS=INDEX, X,Y,Z
  std::filesystem::path out;
  bool sheet = false;
  bool json = false;
  bool diagnose = false;
  bool html = false;
  int bins = 0;  // of the histogram; 0: none

  int run() const;
  std::vector<openvdb::GridBase::Ptr> chosen(const VdbFile& vdb) const;
  std::vector<SlicePlane> planes(const GridSummary& summary) const;
  void write_picture(const std::vector<openvdb::GridBase::Ptr>& grids) const;
  void write_page() const;
};

/// A file's text on a terminal: no control characters.
std::string printable(std::string text) {
  for (char& c : text)
    if ((c >= 0 && c < ' ') || c == 0x7f) c = '?';
  return text;
}

template <typename Value>
std::optional<Json> json_as(const openvdb::Metadata& value) {
  if (const auto* typed = dynamic_cast<const openvdb::TypedMetadata<Value>*>(&value)) return Json(typed->value());
  return std::nullopt;
}

template <typename Vector>
Json triple(const Vector& v) {
  return {v[0], v[1], v[2]};
}

Json to_json(const openvdb::MetaMap& metadata) {
  Json json = Json::object();
  for (const auto& [key, value] : further_metadata(metadata)) {
    std::optional<Json> known = json_as<bool>(*value);
    if (!known) known = json_as<std::int32_t>(*value);
    if (!known) known = json_as<std::int64_t>(*value);
    if (!known) known = json_as<float>(*value);
    if (!known) known = json_as<double>(*value);
    if (const auto* v = dynamic_cast<const openvdb::Vec3IMetadata*>(value.get())) known = triple(v->value());
    json[key] = known ? *known : Json(value->str());
  }
  return json;
}

Json channels(const GridSummary& s, double ChannelRange::*figure) {
  if (s.channels.empty()) return nullptr;
  Json json = Json::array();
  for (const ChannelRange& range : s.channels) json.push_back(range.*figure);
  return json;
}

Json to_json(const GridSummary& s, const openvdb::MetaMap& metadata) {
  Json json{{"name", s.name},        {"type", s.type},
            {"unit", s.unit},        {"description", s.description},
            {"class", s.grid_class}, {"vector_type", s.vector_type}};
  const bool empty = s.active_cells == 0;
  const auto box = [&](const auto& b) {
    return empty ? Json(nullptr) : Json{{"min", triple(b.min())}, {"max", triple(b.max())}};
  };
  json["index_box"] = box(s.index_box);
  json["world_box"] = box(s.world_box);
  json["cell_size_m"] = triple(s.cell_size_m);
  json["active_cells"] = s.active_cells;
  json["active_share"] = s.active_share;
  json["not_finite"] = s.not_finite;
  json["minimum"] = channels(s, &ChannelRange::minimum);
  json["maximum"] = channels(s, &ChannelRange::maximum);
  json["mean"] = channels(s, &ChannelRange::mean);
  json["deviation"] = channels(s, &ChannelRange::deviation);
  json["memory_bytes"] = s.memory_bytes;
  json["metadata"] = to_json(metadata);
  return json;
}

std::string bytes_text(double bytes) {
  if (bytes < 1024.0) return fmt::format("{:.0f} B", bytes);
  return bytes < 1048576.0 ? fmt::format("{:.1f} KiB", bytes / 1024.0) : fmt::format("{:.1f} MiB", bytes / 1048576.0);
}

std::string metadata_text(const openvdb::MetaMap& metadata) {
  std::string text;
  const Json shown = to_json(metadata);
  for (const auto& [key, value] : shown.items())
    text += fmt::format("  {:<12} {}\n", printable(key),
                        printable(value.is_string() ? value.get<std::string>() : value.dump()));
  return text;
}

template <typename Vector>
std::string corner(const Vector& v) {
  return fmt::format("{:.6g},{:.6g},{:.6g}", double(v[0]), double(v[1]), double(v[2]));
}

std::string range_text(const GridSummary& s, const char* name, double ChannelRange::*figure) {
  std::string text = fmt::format("  {:<12}", name);
  for (const ChannelRange& range : s.channels) text += fmt::format(" {:.6g}", range.*figure);
  return text + '\n';
}

std::string grid_text(const GridSummary& s, const openvdb::MetaMap& metadata) {
  const std::string kind = s.vector_type.empty() ? s.type : s.type + ", " + s.vector_type;
  std::string text =
      fmt::format("\n{}{}: {} ({}, {})\n", printable(s.name), s.unit.empty() ? "" : " [" + printable(s.unit) + "]",
                  s.description.empty() ? "no description" : printable(s.description), kind, printable(s.grid_class));
  if (s.active_cells > 0) {
    const openvdb::Coord edge = s.index_box.dim();
    text += fmt::format("  {:<12} {} ... {}, {} x {} x {} cells of {:.6g} m\n", "index box", corner(s.index_box.min()),
                        corner(s.index_box.max()), edge.x(), edge.y(), edge.z(), s.cell_size_m.x());
    text += fmt::format("  {:<12} {} ... {} m\n", "world box", corner(s.world_box.min()), corner(s.world_box.max()));
  }
  text += fmt::format("  {:<12} {} cells, {:.2f} % of the box\n", "active", s.active_cells, 100.0 * s.active_share);
  if (!s.channels.empty())
    text += range_text(s, "minimum", &ChannelRange::minimum) + range_text(s, "maximum", &ChannelRange::maximum) +
            range_text(s, "mean", &ChannelRange::mean) + range_text(s, "deviation", &ChannelRange::deviation);
  if (s.not_finite > 0) text += fmt::format("  {:<12} {} cells\n", "not finite", s.not_finite);
  return text + fmt::format("  {:<12} {}\n", "memory", bytes_text(double(s.memory_bytes))) + metadata_text(metadata);
}

/// One row a step: its lower end, how many cells, and a bar against the fullest; a column for each channel.
std::string histogram_text(const openvdb::GridBase& grid, const GridSummary& s, int bins) {
  std::string text;
  for (size_t c = 0; c < s.channels.size(); ++c) {
    const std::vector<std::uint64_t> counts = histogram(grid, s, int(c), bins);
    const std::uint64_t most = std::max<std::uint64_t>(*std::max_element(counts.begin(), counts.end()), 1);
    const ChannelRange& range = s.channels[c];
    if (s.channels.size() > 1) text += fmt::format("  channel {}\n", c);
    for (size_t k = 0; k < counts.size(); ++k) {
      constexpr double widest = 40.0;
      const double from = range.minimum + (range.maximum - range.minimum) * double(k) / double(bins);
      text += fmt::format("  {:>12.5g} {:>10} {}\n", from, counts[k],
                          std::string(size_t(std::ceil(widest * double(counts[k]) / double(most))), '#'));
    }
  }
  return text;
}

Json histogram_json(const openvdb::GridBase& grid, const GridSummary& s, int bins) {
  Json json = Json::array();
  for (size_t c = 0; c < s.channels.size(); ++c) json.push_back(histogram(grid, s, int(c), bins));
  return json;
}

/// Whether a grid's numbers are numbers: "fluence: OK", "fluence: FAILED, 3 cells are NaN, 1 is infinite".
bool diagnose_grid(const GridSummary& s, std::string& text) {
  const std::uint64_t infinite = s.not_finite - s.not_a_number;
  if (s.not_finite == 0) {
    text += fmt::format("{}: OK, {} active cells\n", printable(s.name), s.active_cells);
    return true;
  }
  text += fmt::format("{}: FAILED, of {} active cells {} are NaN and {} infinite\n", printable(s.name), s.active_cells,
                      s.not_a_number, infinite);
  return false;
}

[[noreturn]] void usage(const std::string& message) { throw Error(ExitCode::usage, message); }

/// Whole numbers between commas.
std::vector<int> parse_indices(const std::string& text) {
  std::vector<int> numbers;
  const char* at = text.data();
  const char* const end = at + text.size();
  for (;; ++at) {
    int number = 0;
    const auto [stop, error] = std::from_chars(at, end, number);
    if (error != std::errc() || (stop != end && *stop != ',')) return {};
    numbers.push_back(number);
    if (stop == end) return numbers;
    at = stop;
  }
}

void check_inside(const std::string& option, const GridSummary& s, SlicePlane plane) {
  const int low = s.index_box.min()[plane.axis], high = s.index_box.max()[plane.axis];
  if (plane.index >= low && plane.index <= high) return;
  usage(fmt::format("{}: {} has cells from {axis} = {} to {axis} = {}", option, printable(s.name), low, high,
                    fmt::arg("axis", "xyz"[plane.axis])));
}

std::vector<openvdb::GridBase::Ptr> InspectCommand::chosen(const VdbFile& vdb) const {
  if (grid.empty()) return vdb.grids;
  std::vector<openvdb::GridBase::Ptr> found;
  std::string names;
  for (const auto& g : vdb.grids) {
    if (g->getName() == grid) found.push_back(g);
    names += (names.empty() ? "" : ", ") + printable(g->getName());
  }
  if (found.empty())
    usage(fmt::format("--grid {}: {} has {}", grid, file.string(), names.empty() ? "no grids" : names));
  return found;
}

std::vector<SlicePlane> InspectCommand::planes(const GridSummary& s) const {
  if (!sheet) {
    const size_t axis = slice.size() > 2 && slice[1] == '=' ? std::string("xyz").find(slice[0]) : std::string::npos;
    const auto index = parse_indices(slice.size() > 2 ? slice.substr(2) : "");
    if (axis == std::string::npos || index.size() != 1)
      usage(fmt::format("--slice {}: takes AXIS=INDEX, such as z=12", slice));
    const SlicePlane plane{int(axis), index[0]};
    check_inside("--slice " + slice, s, plane);
    return {plane};
  }
  std::vector<int> cell(3);
  for (int axis = 0; axis < 3; ++axis)
    cell[size_t(axis)] = int((std::int64_t(s.index_box.min()[axis]) + s.index_box.max()[axis]) / 2);
  if (!at.empty()) cell = parse_indices(at);
  if (cell.size() != 3) usage(fmt::format("--at {}: takes the index X,Y,Z of a cell, such as 8,4,12", at));
  std::vector<SlicePlane> three{{0, cell[0]}, {1, cell[1]}, {2, cell[2]}};
  for (const SlicePlane plane : three) check_inside("--at " + at, s, plane);
  return three;
}

void InspectCommand::write_picture(const std::vector<openvdb::GridBase::Ptr>& grids) const {
  if (grids.size() != 1) {
    std::string names;
    for (const auto& g : grids) names += (names.empty() ? "" : ", ") + printable(g->getName());
    usage(fmt::format("{}: a picture shows one grid, choose it with --grid: {}", file.string(),
                      names.empty() ? "there is none" : names));
  }
  const GridSummary summary = summarise(*grids[0]);
  if (summary.channels.empty())
    throw Error(ExitCode::bad_input,
                fmt::format("{}: {} has no active cells with numbers to show", file.string(), printable(summary.name)));
  write_png_display(out, slice_picture(*grids[0], summary, planes(summary)));
}

void InspectCommand::write_page() const {
  const VdbFile vdb = read_vdb(file);
  write_text_atomically(out, volume_page(printable(file.filename().string()), chosen(vdb)));
}

int InspectCommand::run() const {
  const bool picture = sheet || !slice.empty();
  if (picture && out.empty()) usage("a picture needs -o OUT.png");
  if (html && out.empty()) usage("--html needs -o OUT.html");
  if (!picture && !html && !out.empty()) usage("-o needs --slice, --sheet or --html");
  if (html) {
    if (out.extension() != ".html") usage(out.string() + ": -o needs a name that ends in .html");
    check_writable(out);
    write_page();
    return int(ExitCode::done);
  }
  if (picture) {
    if (out.extension() != ".png") usage(out.string() + ": -o needs a name that ends in .png");
    check_writable(out);
  }
  const VdbFile vdb = read_vdb(file);
  const auto grids = chosen(vdb);
  if (picture) write_picture(grids);
  if (diagnose) {
    bool good = true;
    std::string text;
    for (const auto& g : grids) good = diagnose_grid(summarise(*g), text) && good;
    std::cout << text << (good ? "OK\n" : "FAILED\n");
    return int(good ? ExitCode::done : ExitCode::comparison_failed);
  }
  const auto size = std::filesystem::file_size(file);
  if (json) {
    Json all{{"file", file.string()}, {"bytes", size}, {"metadata", to_json(vdb.metadata)}, {"grids", Json::array()}};
    for (const auto& g : grids) {
      const GridSummary s = summarise(*g);
      all["grids"].push_back(to_json(s, *g));
      if (bins > 0) all["grids"].back()["histogram"] = histogram_json(*g, s, bins);
    }
    // A file's texts need not be UTF-8.
    std::cout << all.dump(1, ' ', false, Json::error_handler_t::replace) << '\n';
  } else if (!picture) {
    std::string text = fmt::format("{}: {} grids, {}\n", file.string(), vdb.grids.size(), bytes_text(double(size)));
    text += metadata_text(vdb.metadata);
    for (const auto& g : grids) {
      const GridSummary s = summarise(*g);
      text += grid_text(s, *g);
      if (bins > 0) text += histogram_text(*g, s, bins);
    }
    std::cout << text;
  }
  return int(ExitCode::done);
}

}  // namespace

void add_inspect_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<InspectCommand>();
  CLI::App* command = app.add_subcommand("inspect", "what an OpenVDB file holds, in figures or as a picture of slices");
  command->add_option("FILE", options->file, "OpenVDB file (.vdb)")->required();
  command->add_option("--grid", options->grid, "only the grid of this name (all)")->type_name("NAME");
  CLI::Option* slice = command->add_option("--slice", options->slice, "write a picture of the cells with this index")
                           ->type_name("AXIS=INDEX");
  CLI::Option* sheet =
      command->add_flag("--sheet", options->sheet, "write a picture of three slices, through the middle or --at");
  slice->excludes(sheet);
  command->add_option("--at", options->at, "cell that the slices of --sheet go through (the middle)")
      ->type_name("X,Y,Z")
      ->needs(sheet);
  CLI::Option* html = command->add_flag("--html", options->html,
                                        "write a page to look at the volume in a browser: slices, histogram, cells in "
                                        "space; it opens from disk");
  html->excludes(slice)->excludes(sheet);
  command->add_option("-o,--output", options->out, "picture to write, .png, or page, .html")->type_name("FILE");
  CLI::Option* json = command->add_flag("--json", options->json, "print JSON")->excludes(html);
  command->add_option("--histogram", options->bins, "counts of cells in so many equal steps of their values")
      ->check(CLI::Range(1, 1000))
      ->type_name("BINS")
      ->excludes(slice)
      ->excludes(sheet)
      ->excludes(html);
  command
      ->add_flag("--diagnose", options->diagnose,
                 "says OK or FAILED of every grid: exit code 1 where a cell is no number")
      ->excludes(json)
      ->excludes(slice)
      ->excludes(sheet)
      ->excludes(html);
  command->footer(
      "Indices are cells, counted as in the file; places are in metres, units as the grids say.\n"
      "Example: volgi inspect out/cornell.vdb --grid fluence --slice z=16 -o out/fluence.png");
  command->callback([options, &exit_code] { exit_code = in_a_child(options->file, [&] { return options->run(); }); });
}

}  // namespace volgi::app
