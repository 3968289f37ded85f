#pragma once
#include <span>
#include <string>
#include <vector>

#include "screen/frame/stage.h"

namespace volgi::screen {

/// Every technique, and every recipe that --gi can name: the one list of both (docs/adding-a-technique.md). --gi, --set
/// and its help, --stats and the report's sweeps come from here.
std::span<const StageType* const> stage_types();
std::span<const Recipe> recipes();

/// @throws Error(usage) for another name, naming those that there are.
const Recipe& find_recipe(const std::string& name);
/// What is taken where nobody names one: the first recipe that these settings allow.
const Recipe& default_recipe(const FrameOptions& options);
/// The one that options.recipe names, or the default one; less options.without, when it claims what is left.
/// @throws Error(usage) for a stage that it does not have, naming those that it has.
Recipe recipe_of(const FrameOptions& options);
/// Names of those that claim all of `paths`: "hybrid, volume or lpv".
std::string recipes_that_carry(LightPaths paths);
/// Options for a recipe, its preset applied.
void apply_recipe(const std::string& name, FrameOptions& options);

/// Those of every picture, then those of techniques; each name once.
std::vector<const Parameter*> parameters();
/// @throws Error(usage) for a name that there is not, naming those that there are.
/// @param shown_as  what messages name; empty: the name.
const Parameter& find_parameter(const std::string& name, const std::string& shown_as = {});
/// NAME=VALUE, as --set takes it. @throws Error(usage) naming the text.
void set_parameter(TypeMap& settings, const std::string& text);

}  // namespace volgi::screen
