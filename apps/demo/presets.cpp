#include "apps/demo/presets.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <vector>

#include "core/error.h"
#include "core/surface.h"
#include "propagation/volume_options.h"
#include "screen/frame/plan.h"
#include "screen/frame/registry.h"

namespace volgi::demo {

namespace {

constexpr std::array FAST = {
    "vpl.count=256",           "vpl.one_of=4", "val.count=24", "val.map=128",     "val.exact=0",     "gather.stride=4",
    "multires.tolerance=0.06", "sky.parts=64", "sky.map=128",  "shadow.spot=512", "shadow.cube=256", "shadow.sun=1024"};
constexpr std::array<const char*, 0> DEFAULT = {};
constexpr std::array FINE = {"vpl.count=4096",           "val.count=256",   "val.interleave=2",   "gather.stride=1",
                             "multires.tolerance=0.015", "sky.parts=512",   "sky.tolerance=0.03", "shadow.spot=2048",
                             "shadow.cube=1024",         "shadow.sun=4096", "negative.count=512"};

constexpr std::array PRESETS = {
    Preset{"fast", "a quarter of the lights and clusters, smaller maps, a grid of 24 cells", FAST, 24},
    Preset{"default", "as `volgi render` has it", DEFAULT, 0},
    Preset{"fine", "four times the lights and clusters, larger maps, a grid of 64 cells", FINE, 64},
};

}  // namespace

std::span<const Preset> presets() { return PRESETS; }

void take_recipe(const std::string& name, screen::FrameOptions& options) {
  const screen::FrameOptions usual;
  screen::FrameOptions brought;
  if (!options.recipe.empty()) screen::apply_recipe(options.recipe, brought);
  for (const screen::Parameter* p : screen::parameters()) {
    if (p->get(options.settings) == p->get(brought.settings)) p->copy(usual.settings, options.settings);
  }
  Scheme& scheme = options.of<VolumeOptions>().scheme.scheme;
  if (scheme == brought.of<VolumeOptions>().scheme.scheme) scheme = usual.of<VolumeOptions>().scheme.scheme;
  options.without.clear();
  screen::apply_recipe(name, options);
}

namespace {

/// Of a picture of the scene; all of the recipe where there is none.
bool has_part(const screen::FrameOptions& options, const Scene& scene, const screen::StageType* type) {
  try {
    const screen::Plan plan =
        screen::plan_picture(screen::recipe_of(options), options, screen::paths_in(scene), shines(scene));
    return std::any_of(plan.steps.begin(), plan.steps.end(), [&](const auto& step) { return step.type == type; });
  } catch (const Error&) {
    return true;
  }
}

}  // namespace

std::string idle_stage(const screen::FrameOptions& options, const Scene& scene, const std::string& name) {
  const screen::Recipe recipe = screen::find_recipe(screen::recipe_of(options).name);
  for (const screen::StageType* type : recipe.stages) {
    if (name != type->name) continue;
    const bool is_off = std::find(options.without.begin(), options.without.end(), name) != options.without.end();
    if (is_off) continue;
    if (!type->role(options).active)
      return fmt::format("stage {}: nothing to do in --gi {} with these options", name, recipe.name);
    if (!has_part(options, scene, type))
      return fmt::format("stage {}: nothing to do in --gi {} in this scene", name, recipe.name);
  }
  return {};
}

void reset_technique(Settings& settings) {
  screen::FrameOptions fresh;
  fresh.backend = settings.frame.backend;
  fresh.light = settings.frame.light;
  if (!settings.frame.recipe.empty()) screen::apply_recipe(settings.frame.recipe, fresh);
  settings.frame = fresh;
  settings.grid_fits_scene = true;
}

void reset_parameter(Settings& settings, const screen::Parameter& parameter) {
  screen::FrameOptions fresh;
  if (!settings.frame.recipe.empty()) screen::apply_recipe(settings.frame.recipe, fresh);
  parameter.copy(fresh.settings, settings.frame.settings);
}

void apply_preset(const std::string& name, Settings& settings) {
  std::vector<std::string> known;
  for (const Preset& preset : PRESETS) {
    known.emplace_back(preset.name);
    if (name != preset.name) continue;
    const screen::FrameOptions before = settings.frame;
    reset_technique(settings);
    settings.frame.bounces = before.bounces;
    settings.frame.without = before.without;
    settings.frame.of<VolumeOptions>().scheme = before.of<VolumeOptions>().scheme;
    for (const char* text : preset.parameters) screen::set_parameter(settings.frame.settings, text);
    settings.grid_fits_scene = preset.grid_cells == 0;
    if (preset.grid_cells > 0) settings.frame.of<VolumeOptions>().grid_cells = preset.grid_cells;
    return;
  }
  throw Error(ExitCode::usage, fmt::format("no preset '{}'; there are {}", name, fmt::join(known, ", ")));
}

}  // namespace volgi::demo
