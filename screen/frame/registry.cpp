#include "screen/frame/registry.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/error.h"
#include "screen/base/base_parameters.h"
#include "screen/bounces/glossy/glossy_stage.h"
#include "screen/bounces/volume/volume_stage.h"
#include "screen/gather/area/area_stage.h"
#include "screen/gather/gather_choice.h"
#include "screen/gather/interleaved/interleaved_stage.h"
#include "screen/gather/multires/multires_stage.h"
#include "screen/gather/strided/strided_stage.h"
#include "screen/gather/subsplats/subsplats_stage.h"
#include "screen/lights/lattice/lattice_stage.h"
#include "screen/lights/light_choice.h"
#include "screen/lights/patches/patches_stage.h"
#include "screen/lights/resample/resample_stage.h"
#include "screen/lights/rsm/rsm_stage.h"
#include "screen/sources/sky/sky_stage.h"
#include "screen/sources/textured_area/textured_area_stage.h"
#include "screen/visibility/area_maps/area_maps_stage.h"
#include "screen/visibility/imperfect/imperfect_stage.h"
#include "screen/visibility/negative/negative_stage.h"
#include "screen/visibility/screen_voxels/screen_voxels_stage.h"
#include "screen/visibility/visibility_choice.h"

namespace volgi::screen {

namespace {

// One line a technique.
constexpr const StageType* STAGE_TYPES[] = {
    &SKY,
    &TEXTURED_AREA,
    &RSM_LIGHTS,
    &RESAMPLED_LIGHTS,
    &LATTICE_LIGHTS,
    &LIGHT_PATCHES,
    &NEGATIVE_LIGHTS_STAGE,
    &AREA_MAPS,
    &IMPERFECT_VISIBILITY,
    &SCREEN_VOXELS,
    &AREA_GATHER,
    &STRIDED_GATHER,
    &INTERLEAVED_GATHER,
    &MULTIRES_GATHER,
    &SUBSPLAT_GATHER,
    &VOLUME,
    &VOLUME_AFTER_FIRST_BOUNCE,
    &GLOSSY,
};

using enum LightPath;
constexpr LightPaths FIRST_ORDER{emission_direct, punctual_first, sky_direct, sky_first};

void prefer_clustered_visibility_as_printed(TypeMap& settings) {
  prefer_sky_by_lights(settings);
  prefer_interleaved_gather(settings);
}

void prefer_lattice_as_printed(TypeMap& settings) {
  prefer_wave_lattice(settings);
  prefer_imperfect_maps(settings);
}

std::vector<Recipe> make_recipes() {
  return {
      {"hybrid",
       "the first bounce on the screen by clustered virtual lights, the others through the volume",
       {&SKY, &TEXTURED_AREA, &RSM_LIGHTS, &RESAMPLED_LIGHTS, &AREA_MAPS, &INTERLEAVED_GATHER, &MULTIRES_GATHER,
        &VOLUME_AFTER_FIRST_BOUNCE, &GLOSSY},
       LightPaths::all()},
      {"volume", "all light but direct light through the volume", {&VOLUME}, LightPaths::all()},
      {"lpv", "volume --scheme lpv2009", {&VOLUME}, LightPaths::all(), &prefer_lpv},
      {"val",
       "one bounce by virtual lights, each as far as its cluster sees (Dong et al. 2009)",
       {&SKY, &RSM_LIGHTS, &RESAMPLED_LIGHTS, &AREA_MAPS, &INTERLEAVED_GATHER, &MULTIRES_GATHER},
       FIRST_ORDER,
       &prefer_clustered_visibility_as_printed},
      {"negative",
       "one bounce by virtual lights, less what negative lights take away (Cochran and Steele 2007)",
       {&SKY, &RSM_LIGHTS, &RESAMPLED_LIGHTS, &NEGATIVE_LIGHTS_STAGE, &STRIDED_GATHER},
       FIRST_ORDER,
       &prefer_sky_by_lights},
      {"vpl",
       "one bounce by virtual lights without shadows",
       {&SKY, &RSM_LIGHTS, &RESAMPLED_LIGHTS, &IMPERFECT_VISIBILITY, &STRIDED_GATHER},
       FIRST_ORDER,
       &prefer_sky_by_lights},
      {"lattice",
       "lights in the air around each light, in place of its reflections (wave lattice)",
       {&LATTICE_LIGHTS, &IMPERFECT_VISIBILITY, &STRIDED_GATHER},
       {punctual_first, punctual_higher},
       &prefer_lattice_as_printed},
      {"multires",
       "one bounce by a grid of virtual lights, gathered or splatted at many resolutions (Nichols 2010, chapter 3)",
       {&LIGHT_PATCHES, &NEGATIVE_LIGHTS_STAGE, &AREA_MAPS, &SUBSPLAT_GATHER},
       {punctual_first},
       &prefer_light_grid},
      {"radiosity",
       "one bounce by patches of light of many sizes, the same for all (Nichols 2010, chapter 4)",
       {&LIGHT_PATCHES, &NEGATIVE_LIGHTS_STAGE, &AREA_MAPS, &SUBSPLAT_GATHER},
       {punctual_first},
       &prefer_light_patches},
      {"hierarchical",
       "one bounce by a tree of patches of light, other ones for each fragment (Nichols 2010, chapter 4)",
       {&LIGHT_PATCHES, &NEGATIVE_LIGHTS_STAGE, &AREA_MAPS, &SUBSPLAT_GATHER},
       {punctual_first},
       &prefer_light_hierarchy},
      {"area",
       "light straight from emissive surfaces, textures kept, by lights on them seen through voxels (Nichols 2010)",
       {&TEXTURED_AREA, &SCREEN_VOXELS, &AREA_GATHER},
       {emission_direct}},
      {"none", "direct light of punctual lights and the sky alone", {&SKY}, {sky_direct}},
  };
}

}  // namespace

std::span<const StageType* const> stage_types() { return STAGE_TYPES; }

std::span<const Recipe> recipes() {
  static const std::vector<Recipe> all = make_recipes();
  return all;
}

const Recipe& find_recipe(const std::string& name) {
  std::vector<std::string> known;
  for (const Recipe& recipe : recipes()) {
    if (name == recipe.name) return recipe;
    known.emplace_back(recipe.name);
  }
  throw Error(ExitCode::usage, fmt::format("--gi {}: no such recipe; there are {}", name, fmt::join(known, ", ")));
}

const Recipe& default_recipe(const FrameOptions& options) {
  for (const Recipe& recipe : recipes()) {
    try {
      for (const StageType* stage : recipe.stages) stage->role(options);
      return recipe;
    } catch (const Error&) {
    }
  }
  return recipes().back();
}

Recipe recipe_of(const FrameOptions& options) {
  Recipe recipe = options.recipe.empty() ? default_recipe(options) : find_recipe(options.recipe);
  if (options.without.empty()) return recipe;
  std::vector<std::string> known;
  for (const StageType* stage : recipe.stages) known.emplace_back(stage->name);
  for (const std::string& name : options.without) {
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw Error(ExitCode::usage, fmt::format("--without {}: --gi {} has no such stage; it has {}", name, recipe.name,
                                               fmt::join(known, ", ")));
    std::erase_if(recipe.stages, [&](const StageType* stage) { return name == stage->name; });
  }
  LightPaths carried;
  for (const StageType* stage : recipe.stages) {
    for (const StageRole::Light& light : stage->role(options).adds) {
      if (light.share != LightShare::mirror) carried = carried | light.paths;
    }
  }
  recipe.claims = recipe.claims & carried;
  return recipe;
}

std::string recipes_that_carry(LightPaths paths) {
  std::vector<std::string> names;
  for (const Recipe& recipe : recipes()) {
    if ((paths - recipe.claims).empty()) names.emplace_back(recipe.name);
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

void apply_recipe(const std::string& name, FrameOptions& options) {
  const Recipe& recipe = find_recipe(name);
  options.recipe = recipe.name;
  options.of<LightChoice>() = {};  // of the recipe alone: no parameter, which could be kept from another one
  if (recipe.preset != nullptr) recipe.preset(options.settings);
}

std::vector<const Parameter*> parameters() {
  std::vector<const Parameter*> all;
  const auto add = [&](std::span<const Parameter> some) {
    for (const Parameter& p : some) {
      const auto same = [&](const Parameter* known) { return std::string(known->name) == p.name; };
      if (std::none_of(all.begin(), all.end(), same)) all.push_back(&p);
    }
  };
  add(base_parameters());
  for (const StageType* stage : STAGE_TYPES) add(stage->parameters);
  return all;
}

const Parameter& find_parameter(const std::string& name, const std::string& shown_as) {
  std::vector<std::string> known;
  for (const Parameter* p : parameters()) {
    if (name == p->name) return *p;
    known.emplace_back(p->name);
  }
  throw Error(ExitCode::usage, fmt::format("--set {}: no such parameter; there are {}",
                                           shown_as.empty() ? name : shown_as, fmt::join(known, ", ")));
}

void set_parameter(TypeMap& settings, const std::string& text) {
  const size_t equals = text.find('=');
  if (equals == std::string::npos) {
    throw Error(ExitCode::usage, fmt::format("--set {}: give NAME=VALUE, such as grid.shift=0.25", text));
  }
  const Parameter& p = find_parameter(text.substr(0, equals), text);
  p.set(settings, parse_value(p, text.substr(equals + 1), "--set " + text));
}

}  // namespace volgi::screen
