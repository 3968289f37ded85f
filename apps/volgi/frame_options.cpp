#include "apps/volgi/frame_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "core/error.h"
#include "screen/frame/choice.h"
#include "screen/frame/registry.h"

namespace volgi::app {

namespace {

const std::map<std::string, screen::LightPart> LIGHTS = {{"full", screen::LightPart::full},
                                                         {"direct", screen::LightPart::direct},
                                                         {"indirect", screen::LightPart::indirect}};
const std::map<std::string, screen::Backend> BACKENDS = {
    {"auto", screen::Backend::automatic}, {"gpu", screen::Backend::gpu}, {"cpu", screen::Backend::cpu}};

std::string recipe_help() {
  std::string text = "technique:";
  for (const screen::Recipe& r : screen::recipes()) text += fmt::format("\n  {}: {}", r.name, r.help);
  text += "\n  auto: the one, and its parameters, that --budget asks for in this scene";
  return text + fmt::format("\n({}; with the papers' schemes volume)", screen::recipes().front().name);
}

std::string parameter_help() {
  std::string text = "technique parameters NAME=VALUE:";
  for (const screen::Parameter* p : screen::parameters()) text += "\n  " + screen::help_line(*p);
  return text;
}

}  // namespace

void FrameCommandOptions::add_to(CLI::App& command) {
  std::vector<std::string> names;
  for (const screen::Recipe& r : screen::recipes()) names.emplace_back(r.name);
  names.emplace_back(AUTOMATIC);
  command.add_option("--gi", gi, recipe_help())->check(CLI::IsMember(names));
  command
      .add_option("--budget", budget,
                  "of --gi auto: time a picture such as 50ms, or error such as 3% (root mean square, of the shown "
                  "light's mean); by what "
                  "other scenes took, on this device where volgi calibrate has measured it")
      ->type_name("TIME|ERROR%");
  command.add_flag("--explain", explain, "--gi auto: what was not chosen, and what it would take and show");
  command.add_option("--light", light, "light shown; direct: straight from any emitter, indirect: after a reflection")
      ->check(CLI::IsMember(LIGHTS))
      ->capture_default_str();
  command.add_option("--backend", backend, "where the volume is computed; auto: the CPU where GL is software")
      ->check(CLI::IsMember(BACKENDS))
      ->capture_default_str();
  command
      .add_option("--quality", quality,
                  "cells, lights, clusters, maps and samples by the scene, where no other option says so; truth: more "
                  "of them until two answers in turn differ by less than 1 %")
      ->check(
          CLI::IsMember(std::vector<std::string>(std::begin(screen::QUALITY_NAMES), std::end(screen::QUALITY_NAMES))))
      ->capture_default_str();
  command.add_option("--cells-times", cells_times, "cells along the volume, times those of --quality")
      ->check(CLI::Range(0.1, 10.0))
      ->capture_default_str();
  command.add_option("--lights-times", lights_times, "virtual lights and clusters, times those of --quality")
      ->check(CLI::Range(0.001, 16.0))
      ->capture_default_str();
  volume.add_to(command);
  volume.add_cascades_to(command);
  for (const screen::Parameter* p : screen::parameters()) {
    if (p->flag == nullptr) continue;
    const auto keep = [this, p](const std::string& text) {
      screen::parse_value(*p, text, std::string(p->flag) + " " + text);
      flagged[p->name] = text;
    };
    command.add_option_function<std::string>(p->flag, keep, screen::help_text(*p))->type_name("N");
  }
  command.add_option("--set", parameters, parameter_help());
  command.add_option("--without", without, "leaves a stage of --gi out, such as visibility/negative; may be repeated")
      ->type_name("STAGE");
}

/// Says before anything is loaded what auto cannot do.
void FrameCommandOptions::check_automatic() const {
  if (!automatic()) {
    if (!budget.empty() || explain)
      throw Error(ExitCode::usage, std::string(explain ? "--explain" : "--budget") + ": goes with --gi auto");
    return;
  }
  if (budget.empty()) throw Error(ExitCode::usage, "--gi auto: for what? --budget 50ms, or 3%");
  screen::parse_budget(budget);
  const FrameCommandOptions usual;
  if (quality != usual.quality || cells_times != usual.cells_times || lights_times != usual.lights_times)
    throw Error(ExitCode::usage, "--gi auto: chooses --quality, --cells-times and --lights-times itself");
  if (light == "direct") throw Error(ExitCode::usage, "--gi auto: --light direct leaves nothing to choose");
}

screen::FrameOptions FrameCommandOptions::without_recipe(glm::ivec2 size) const {
  screen::FrameOptions o;
  o.light = LIGHTS.at(light);
  o.size = size;
  o.backend = BACKENDS.at(backend);
  o.without = without;
  o.bounces = volume.bounces;
  o.of<VolumeOptions>() = volume.volume_options();
  set_parameters(o);
  return o;
}

void FrameCommandOptions::set_parameters(screen::FrameOptions& o) const {
  for (const auto& [name, text] : flagged) {
    const screen::Parameter& p = screen::find_parameter(name);
    p.set(o.settings, screen::parse_value(p, text, std::string(p.flag) + " " + text));
  }
  for (const std::string& text : parameters) screen::set_parameter(o.settings, text);
}

bool FrameCommandOptions::given() const {
  const FrameCommandOptions usual;
  return !gi.empty() || light != usual.light || backend != usual.backend || quality != usual.quality ||
         cells_times != usual.cells_times || lights_times != usual.lights_times || !flagged.empty() ||
         !parameters.empty() || !without.empty() || volume.given();
}

FrameCommandOptions::Fitted FrameCommandOptions::fit(const Scene& scene, const std::optional<glm::vec3>& eye, int rung,
                                                     screen::FrameOptions& options) const {
  const std::optional<GridBox> reached = volume.fit_box(scene, eye, options.of<VolumeOptions>());
  std::vector<std::string> keep;
  for (const auto& [name, text] : flagged) keep.push_back(name);
  for (const std::string& text : parameters) keep.push_back(text.substr(0, text.find('=')));
  if (volume.grid_cells) keep.emplace_back("grid");
  Fitted fitted;
  fitted.facts = facts ? *facts : scene_facts(scene, options.of<VolumeOptions>().grid_box, volume.grid_cells);
  fitted.needs = screen::scaled(screen::needs_of(screen::quality_from_name(quality), rung, fitted.facts), cells_times,
                                lights_times);
  fitted.chosen = screen::apply_needs(fitted.needs, keep, options);
  if (reached) warn_of_large_cells(scene, *reached, options.of<VolumeOptions>());
  return fitted;
}

std::string FrameCommandOptions::technique() const {
  return gi.empty() || automatic() ? screen::default_recipe(without_recipe(glm::ivec2(1))).name : gi;
}

screen::FrameOptions FrameCommandOptions::frame_options(glm::ivec2 size) const {
  check_automatic();
  screen::FrameOptions o = without_recipe(size);
  screen::apply_recipe(technique(), o);
  set_parameters(o);  // once more: what was asked for goes over what the recipe prefers
  // Says what does not go together before anything is loaded.
  for (const screen::StageType* stage : screen::recipe_of(o).stages) stage->role(o);
  return o;
}

}  // namespace volgi::app
