#include "apps/demo/parameter_text.h"

#include <fmt/format.h>

#include <cstdlib>

#include "screen/frame/registry.h"

namespace volgi::demo {

namespace {

using screen::Parameter;

std::string shortest_text(const Parameter& p, double value) {
  if (!p.value_names.empty()) return p.value_names[size_t(value)];
  screen::TypeMap given;
  p.set(given, value);
  for (int digits = 6; digits < 17; ++digits) {
    std::string text = fmt::format("{:.{}g}", value, digits);
    const double shown = std::strtod(text.c_str(), nullptr);
    if (shown < p.least || shown > p.most) continue;
    screen::TypeMap made;
    p.set(made, shown);
    if (p.get(made) == p.get(given)) return text;
  }
  return fmt::format("{:.17g}", value);
}

}  // namespace

std::vector<std::pair<const Parameter*, std::string>> parameters_set(const screen::FrameOptions& options) {
  screen::FrameOptions recipe;
  if (!options.recipe.empty()) screen::apply_recipe(options.recipe, recipe);
  std::vector<std::pair<const Parameter*, std::string>> list;
  for (const Parameter* p : screen::parameters()) {
    const std::optional<double> value = p->get(options.settings);
    if (value && value != p->get(recipe.settings)) list.emplace_back(p, shortest_text(*p, *value));
  }
  return list;
}

}  // namespace volgi::demo
