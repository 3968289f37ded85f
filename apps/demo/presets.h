#pragma once
#include <span>
#include <string>

#include "apps/demo/settings.h"
#include "screen/frame/frame_options.h"
#include "screen/frame/parameter.h"

namespace volgi::demo {

/// A named set of parameters, from quick to careful.
struct Preset {
  const char* name;
  const char* help;
  std::span<const char* const> parameters;  // as --set takes them
  int grid_cells;                           // 0: by the scene
};
std::span<const Preset> presets();
/// The recipe stays; all other parameters of techniques are its own or the preset's.
/// @throws Error(usage) naming those that there are.
void apply_preset(const std::string& name, Settings& settings);

/// Another recipe, with all its stages. What the one before brought along goes with it, where nobody has chosen
/// otherwise since. @throws Error(usage) naming those that there are.
void take_recipe(const std::string& name, screen::FrameOptions& options);

/// Why a stage of the recipe has nothing to do with these options in this scene, so that a switch for it would change
/// nothing, as the interleaved gather where another is chosen, or mirrors where nothing shines; empty where it has, or
/// where there is no such stage.
std::string idle_stage(const screen::FrameOptions& options, const Scene& scene, const std::string& name);

/// All parameters, the volume's scheme and its grid to what the recipe has.
void reset_technique(Settings& settings);
void reset_parameter(Settings& settings, const screen::Parameter& parameter);

}  // namespace volgi::demo
