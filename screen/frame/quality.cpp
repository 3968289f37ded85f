#include "screen/frame/quality.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "propagation/volume_options.h"
#include "screen/base/base_parameters.h"
#include "screen/frame/registry.h"

namespace volgi::screen {

namespace {

// Lit area over the square of half of the light's ways: rooms have up to that (cornell 3.7, room704 7.5), for which the
// defaults are made; atrium 26, steps 53, arena 251.
constexpr double ROOM_SPREAD = 8.0;
constexpr double MOST_LIGHTS = 16.0;     // 1024 clusters, which is as many as there may be
constexpr double MOST_BY_DEFAULT = 4.0;  // 256 clusters, four times a frame's time
constexpr int LEAST_CELLS = 16;

int cells_times(const SceneFacts& facts, double factor) {
  return std::clamp(int(std::lround(facts.cells * factor)), LEAST_CELLS, VolumeOptions::kMaxDenseGridCells);
}

bool contains(std::span<const std::string> names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

Quality quality_from_name(const std::string& name) {
  for (size_t k = 0; k < std::size(QUALITY_NAMES); ++k) {
    if (name == QUALITY_NAMES[k]) return Quality(k);
  }
  throw Error(ExitCode::usage, fmt::format("no quality '{}'; there are {}", name, fmt::join(QUALITY_NAMES, ", ")));
}

double lights_for(const SceneFacts& facts) {
  if (!(facts.flight_m > 0.0f)) return 1.0;
  const double spread = double(facts.lit_area_m2) / (double(facts.flight_m) * double(facts.flight_m));
  return std::clamp(spread / ROOM_SPREAD, 1.0, MOST_LIGHTS);
}

Needs needs_of(Quality quality, int rung, const SceneFacts& facts) {
  const double lights = lights_for(facts);
  switch (quality) {
    case Quality::fast:
      return {cells_times(facts, 0.6), 0.25 * std::min(lights, MOST_BY_DEFAULT), 0.5, 2.0, 1};
    case Quality::standard:
      return {facts.cells, std::min(lights, MOST_BY_DEFAULT), 1.0, 1.0, 1};
    case Quality::fine:
      return {cells_times(facts, 1.5), 4.0 * std::min(lights, MOST_BY_DEFAULT), 1.0, 0.5, 4};
    case Quality::truth:
      break;
  }
  // Maps stay as they are: finer ones show the edges of single clusters' shadows (docs/results/quality.md).
  const double more = std::exp2(rung);
  return {cells_times(facts, 2.0 * std::pow(1.2, rung)), std::min(4.0 * more * lights, MOST_LIGHTS), 1.0, 0.0,
          8 << rung};
}

Needs scaled(Needs needs, double cells_times, double lights_times) {
  needs.cells = std::clamp(int(std::lround(needs.cells * cells_times)), LEAST_CELLS, VolumeOptions::kMaxDenseGridCells);
  needs.lights = std::min(needs.lights * lights_times, MOST_LIGHTS);
  return needs;
}

std::vector<Chosen> apply_needs(const Needs& needs, std::span<const std::string> keep, FrameOptions& options) {
  TypeMap suited = options.settings;
  suit_base(needs, suited);
  for (const StageType* stage : recipe_of(options).stages) {
    if (stage->suit != nullptr) stage->suit(needs, suited);
  }
  std::vector<Chosen> chosen;
  int& cells = options.of<VolumeOptions>().grid_cells;
  if (!contains(keep, "grid")) {
    cells = needs.cells;
    chosen.push_back({"grid", std::to_string(cells)});
  }
  for (const Parameter* p : parameters()) {
    if (contains(keep, p->name) || p->get(suited) == p->get(options.settings)) continue;
    p->copy(suited, options.settings);
    chosen.push_back({p->name, value_text(*p, options.settings)});
  }
  return chosen;
}

std::vector<std::string> values_left_alone(const Needs& needs, const FrameOptions& options) {
  FrameOptions fitted = options;
  apply_needs(needs, {}, fitted);
  std::vector<std::string> values;
  for (const Parameter* p : parameters()) {
    const auto own = p->get(options.settings);
    if (own && own != p->get(fitted.settings))
      values.push_back(fmt::format("{}={}", p->name, value_text(*p, options.settings)));
  }
  return values;
}

bool Climb::next(const Image& answer) {
  if (rung_++ == 0) {
    last_ = answer;
    return true;
  }
  double squares = 0.0, sum = 0.0;
  for (size_t i = 0; i < answer.pixels.size(); ++i) {
    const glm::dvec3 now(answer.pixels[i]), change = now - glm::dvec3(last_.pixels[i]);
    squares += glm::dot(change, change);
    sum += now.x + now.y + now.z;
  }
  const double values = 3.0 * std::max<double>(1.0, double(answer.pixels.size()));
  changes_.push_back(sum > 0.0 ? 100.0 * std::sqrt(squares / values) / (sum / values) : 0.0);
  last_ = answer;
  return !agrees() && rung_ < RUNGS;
}

}  // namespace volgi::screen
