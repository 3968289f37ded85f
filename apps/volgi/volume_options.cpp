#include "apps/volgi/volume_options.h"

#include <fmt/format.h>
#include <tbb/global_control.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <charconv>
#include <map>
#include <memory>

#include "core/error.h"
#include "core/log.h"
#include "core/visibility/reach.h"
#include "propagation/light_in/automatic_grid.h"
#include "voxel/grid.h"

namespace volgi::app {

namespace {

const std::map<std::string, Scheme> kSchemes = {{"ordinates", Scheme::ordinates},
                                                {"conservative", Scheme::conservative},
                                                {"gaitatzes2010", Scheme::gaitatzes2010},
                                                {"lpv2009", Scheme::lpv2009}};

/// Two corners in the file's frame, in any order.
GridBox box_of(const std::vector<double>& bounds, const Scene& scene) {
  const glm::dvec3 a(bounds[0], bounds[1], bounds[2]), b(bounds[3], bounds[4], bounds[5]);
  const GridBox box{glm::vec3(glm::min(a, b) - scene.world_origin), glm::vec3(glm::max(a, b) - scene.world_origin)};
  if (glm::any(glm::greaterThan(box.min, scene.bounds_max)) || glm::any(glm::lessThan(box.max, scene.bounds_min)))
    throw Error(ExitCode::usage, "--bounds: nothing of the scene is in that box");
  return box;
}

const std::map<std::string, VolumeOptions::FirstLight> kFirstLights = {{"auto", VolumeOptions::FirstLight::automatic},
                                                                       {"rays", VolumeOptions::FirstLight::rays},
                                                                       {"faces", VolumeOptions::FirstLight::faces}};

/// @throws Error(usage) for what is not six numbers.
GridBox cascade_box(const std::string& text, const Scene& scene) {
  std::vector<double> corners;
  const char *at = text.data(), *end = text.data() + text.size();
  for (double number = 0.0; at < end;) {
    const auto [stop, error] = std::from_chars(at, end, number);
    const bool more = stop < end && *stop == ',';
    if (error != std::errc() || (stop != end && !more) || (more && stop + 1 == end)) break;
    corners.push_back(number);
    at = more ? stop + 1 : stop;
  }
  if (at != end || corners.size() != 6)
    throw Error(ExitCode::usage, "--cascade " + text + ": give two corners, X0,Y0,Z0,X1,Y1,Z1");
  const glm::dvec3 a(corners[0], corners[1], corners[2]), b(corners[3], corners[4], corners[5]);
  return {glm::vec3(glm::min(a, b) - scene.world_origin), glm::vec3(glm::max(a, b) - scene.world_origin)};
}

float longest_edge(const GridBox& box) {
  const glm::vec3 e = box.max - box.min;
  return std::max({e.x, e.y, e.z});
}

std::optional<GridBox> reached_from(const Scene& scene, glm::vec3 eye) {
  const auto reached = reached_box(scene, places_of_light(scene, eye));
  if (!reached) return {};
  return GridBox{reached->min, reached->max};
}

/// Half of the edge: twice the cells. Less is not worth that a grid depends on where the camera stands.
bool is_much_smaller(const GridBox& box, const Scene& scene) {
  return longest_edge(box) < 0.5f * longest_edge({scene.bounds_min, scene.bounds_max});
}

size_t parse_bytes(const std::string& text) {
  std::uint64_t number = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number);
  const std::string unit(stop, end);
  const std::map<std::string, int> shifts = {{"", 0}, {"K", 10}, {"M", 20}, {"G", 30}};
  const auto shift = shifts.find(unit);
  if (error != std::errc() || shift == shifts.end() || number == 0 || number > (UINT64_MAX >> 31)) {
    throw Error(ExitCode::usage, fmt::format("--memory-limit {}: give bytes, such as 536870912, 512M or 2G", text));
  }
  return size_t(number << shift->second);
}

}  // namespace

void warn_of_large_cells(const Scene& scene, const GridBox& reached, const VolumeOptions& options) {
  constexpr float LEAST_CELLS = 4.0f;  // along the shortest edge; fewer cannot hold a room (docs/theory.md#ordinates)
  const glm::vec3 e = reached.max - reached.min;
  const float shortest = std::min({e.x, e.y, e.z});
  const Grid grid = make_grid(scene, options.grid_cells, glm::vec3(0.0f), options.grid_box);
  const float cell = make_cascade(grid, options.cascade).grids.back().cell_size_m;
  if (shortest < 1e-3f * longest_edge(reached) || shortest >= LEAST_CELLS * cell) return;  // a plane has no height
  warn_once(
      fmt::format("{}: cells of {:.2g} m for a place of {:.2g} x {:.2g} x {:.2g} m; its light will be wrong: a larger "
                  "--grid, or --bounds around what matters",
                  scene.name, cell, e.x, e.y, e.z));
}

Scheme scheme_from_name(const std::string& name) {
  const auto found = kSchemes.find(name);
  if (found == kSchemes.end())
    throw Error(ExitCode::usage,
                fmt::format("no scheme '{}'; there are ordinates, conservative, gaitatzes2010, lpv2009", name));
  return found->second;
}

const char* scheme_name(Scheme scheme) {
  for (const auto& [name, s] : kSchemes) {
    if (s == scheme) return name.c_str();
  }
  return "";
}

void VolumeCommandOptions::add_to(CLI::App& command) {
  command
      .add_option(
          "--grid", grid_cells,
          "cells along the longest axis of the scene, on the GPU and of other schemes than ordinates up to 256 (by the "
          "scene: 48, more where they would exceed 0.3 m, short ways of light or gaps that it passes)")
      ->check(CLI::Range(1, VolumeOptions::kMaxGridCells));
  command
      .add_option(
          "--bounds", bounds,
          "X0,Y0,Z0,X1,Y1,Z1: box of the grid in the file's frame [m]; what is outside of it is dark (what camera and "
          "lamps reach, where that is less than half of the scene, or the scene)")
      ->expected(6)
      ->delimiter(',');
  command
      .add_option(
          "--scheme", scheme,
          "how the volume propagates light; conservative is a baseline: in the middle of walls 2.5 to 5 % too bright, "
          "around things that float up to 15")
      ->check(CLI::IsMember({"ordinates", "conservative", "gaitatzes2010", "lpv2009"}))
      ->capture_default_str();
  command.add_option("--sh-order", sh_order, "order of the spherical harmonics of all schemes but 'ordinates'")
      ->check(CLI::IsMember({1, 2}))
      ->capture_default_str();
  command.add_option("--directions", directions, "directions of 'ordinates', 512 on the CPU (by the grid)")
      ->check(CLI::IsMember({8, 24, 48, 80, 128, 512}));
  command.add_option("--bounces", bounces, "reflections to follow, 0 is direct light only (all)")
      ->check(CLI::Range(0, 1000));
  command
      .add_option("--iterations", iterations,
                  "passes over the volume: for each order with --bounces, else in all with reflections in flight "
                  "together (until under 0.2 % of the light is left; 64 for the papers' schemes)")
      ->check(CLI::Range(1, 100000));
  command
      .add_option(
          "--first-light", first_light,
          "how the light of lamps finds the volume's surfaces, on the CPU: rays through all triangles, or faces "
          "of the grid, which need no tree of the triangles; auto: rays up to 16 million triangles")
      ->check(CLI::IsMember(kFirstLights))
      ->capture_default_str();
  command.add_option("--memory-limit", memory_limit, "refuse a volume that needs more bytes, such as 512M or 2G");
  command.add_option("--threads", threads, "threads of the CPU (all)")->check(CLI::Range(1, 1024));
}

void VolumeCommandOptions::add_cascades_to(CLI::App& command) {
  CLI::Option* around = command.add_option(
      "--cascades", cascades,
      "nested grids around the camera, that of --grid among them: each next one inside has as many cells, half as "
      "long; on the CPU, of 'ordinates'; they move with the camera by 8 cells of the grid around (1)");
  around->check(CLI::Range(1, CascadeOptions::kMostLevels));
  command
      .add_option(
          "--cascade", cascade,
          "X0,Y0,Z0,X1,Y1,Z1: box of a nested grid in the file's frame [m] instead, made up to whole blocks of 8^3 "
          "cells of the grid around it; once for each, from outside in")
      ->excludes(around)
      ->allow_extra_args(false);
  command
      .add_option("--cascade-ratio", cascade_ratio, "edge of a grid's cells over that of the next one inside, 2 or 4")
      ->check(CLI::IsMember({2, 4}))
      ->capture_default_str();
}

bool VolumeCommandOptions::given() const {
  const VolumeCommandOptions usual;
  return scheme != usual.scheme || first_light != usual.first_light || bounces || iterations || directions ||
         sh_order != usual.sh_order || grid_cells || !bounds.empty() || !memory_limit.empty() || cascades ||
         !cascade.empty();
}

VolumeOptions VolumeCommandOptions::volume_options() const {
  VolumeOptions o;
  if (grid_cells) o.grid_cells = *grid_cells;
  o.scheme.scheme = scheme_from_name(scheme);
  o.scheme.directions = directions;
  o.scheme.sh_order = sh_order;
  o.bounces = bounces;
  o.iterations = iterations;
  o.first_light = kFirstLights.at(first_light);
  o.cascade.levels = cascades.value_or(1);
  o.cascade.ratio = cascade_ratio;
  if (!cascade.empty()) {
    o.cascade.levels = 1 + int(cascade.size());
    o.cascade.by_boxes = true;  // fit_box() says where
    if (o.cascade.levels > CascadeOptions::kMostLevels)
      throw Error(ExitCode::usage, fmt::format("--cascade: {} boxes at most", CascadeOptions::kMostLevels - 1));
  }
  if (o.cascade.nested() && scheme != "ordinates")
    throw Error(ExitCode::usage, "--cascades belong to --scheme ordinates");
  if (!memory_limit.empty()) o.memory_limit = parse_bytes(memory_limit);
  if (directions && scheme != "ordinates") throw Error(ExitCode::usage, "--directions belongs to --scheme ordinates");
  if (sh_order == 2 && scheme == "ordinates")
    throw Error(ExitCode::usage, "--sh-order 2 belongs to the schemes of spherical harmonics, not to 'ordinates'");
  bounce_rules(o, 0.5f);  // says what does not go together before anything is loaded
  return o;
}

std::optional<GridBox> VolumeCommandOptions::fit_box(const Scene& scene, const std::optional<glm::vec3>& eye,
                                                     VolumeOptions& options) const {
  if (eye) options.cascade.around = *eye;
  for (size_t i = 0; i < cascade.size(); ++i) options.cascade.boxes[i] = cascade_box(cascade[i], scene);
  if (!bounds.empty()) {
    options.grid_box = box_of(bounds, scene);
    return {};
  }
  if (!eye) return {};
  const std::optional<GridBox> reached = reached_from(scene, *eye);
  if (reached && is_much_smaller(*reached, scene)) options.grid_box = reached;
  return reached;
}

void VolumeCommandOptions::fit_grid(const Scene& scene, VolumeOptions& options) const {
  fit_box(scene, std::nullopt, options);
  if (!grid_cells) options.grid_cells = automatic_grid_cells(scene, options.grid_box);
}

void VolumeCommandOptions::limit_threads() const {
  if (!threads) return;
  static std::unique_ptr<tbb::global_control> control;
  control = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism, size_t(*threads));
}

}  // namespace volgi::app
