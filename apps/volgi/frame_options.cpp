#include "apps/volgi/frame_options.h"

#include <charconv>

#include "core/error.h"

namespace volgi::app {

namespace {

struct Parameter {
  const char* name;
  const char* help;
  double least, most;
  void (*set)(screen::FrameOptions&, double);
};

// What --set takes. Resolutions in texels of a layer's edge.
constexpr Parameter kParameters[] = {
    {"shadow.spot", "texels on a side of a spot's map (1024)", 16, 8192,
     [](auto& o, double v) { o.shadow_resolution.spot = int(v); }},
    {"shadow.cube", "texels on a side of a point light's six maps (512)", 16, 8192,
     [](auto& o, double v) { o.shadow_resolution.cube_face = int(v); }},
    {"shadow.sun", "texels on a side of a directional light's map (2048)", 16, 8192,
     [](auto& o, double v) { o.shadow_resolution.sun = int(v); }},
    {"grid.shift", "moves the grid by this part of a cell on each axis, -1 ... 1 (0)", -1, 1,
     [](auto& o, double v) { o.grid_shift_cells = glm::vec3(float(v)); }},
};

std::string parameter_help() {
  std::string text = "technique parameters NAME=VALUE:";
  for (const Parameter& p : kParameters) text += std::string("\n  ") + p.name + ": " + p.help;
  return text;
}

void set_parameter(screen::FrameOptions& options, const std::string& text) {
  size_t equals = text.find('=');
  std::string name = text.substr(0, equals);
  for (const Parameter& p : kParameters) {
    if (name != p.name) continue;
    double value = 0.0;
    const char* end = text.data() + text.size();
    const char* begin = equals == std::string::npos ? end : text.data() + equals + 1;
    auto [stop, error] = std::from_chars(begin, end, value);
    if (begin == end || error != std::errc() || stop != end || !(value >= p.least && value <= p.most)) {
      throw Error(ExitCode::usage, "--set " + text + ": needs a number from " + std::to_string(int(p.least)) + " to " +
                                       std::to_string(int(p.most)));
    }
    p.set(options, value);
    return;
  }
  std::string known;
  for (const Parameter& p : kParameters) known += std::string(known.empty() ? "" : ", ") + p.name;
  throw Error(ExitCode::usage, "--set " + text + ": no such parameter; there are " + known);
}

}  // namespace

void FrameCommandOptions::add_to(CLI::App& command) {
  command.add_option("--gi", gi, "technique")->check(CLI::IsMember({"none", "volume"}))->capture_default_str();
  command.add_option("--light", light, "light shown; direct: straight from any emitter, indirect: after a reflection")
      ->check(CLI::IsMember({"full", "direct", "indirect"}))
      ->capture_default_str();
  command.add_option("--bounces", bounces, "reflections to follow, 0 is direct light only (all)")
      ->check(CLI::Range(0, 1000));
  command.add_option("--grid", grid_cells, "cells along the longest axis of the scene")
      ->check(CLI::Range(1, 128))
      ->capture_default_str();
  command.add_option("--scheme", scheme, "how the volume propagates light")
      ->check(CLI::IsMember({"ordinates", "conservative"}))
      ->capture_default_str();
  command.add_option("--directions", directions, "directions of 'ordinates' (24 up to 16 cells, 48 above)")
      ->check(CLI::IsMember({8, 24, 48, 80}));
  command
      .add_option("--iterations", iterations,
                  "passes over the volume: for each order with --bounces, else in all with reflections in flight "
                  "together (until under 0.2 % of the light is left)")
      ->check(CLI::Range(1, 100000));
  command.add_option("--set", parameters, parameter_help());
}

screen::FrameOptions FrameCommandOptions::frame_options(glm::ivec2 size) const {
  screen::FrameOptions o;
  o.gi = gi == "none" ? screen::GiMode::none : screen::GiMode::volume;
  o.light = light == "full"     ? screen::LightPart::full
            : light == "direct" ? screen::LightPart::direct
                                : screen::LightPart::indirect;
  o.size = size;
  o.grid_cells = grid_cells;
  o.bounces = bounces;
  o.iterations = iterations;
  o.scheme = scheme == "ordinates" ? screen::Scheme::ordinates : screen::Scheme::conservative;
  o.directions = directions;
  if (directions && scheme != "ordinates") throw Error(ExitCode::usage, "--directions belongs to --scheme ordinates");
  for (const std::string& p : parameters) set_parameter(o, p);
  return o;
}

}  // namespace volgi::app
