#include "apps/report/sweep.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "core/error.h"
#include "core/one_line.h"

namespace volgi::app {
namespace {

using Json = nlohmann::ordered_json;

// What an option pair is known by: --set grid.shift=0.5 is another option than --set gather.stride=2.
std::string key_of(const std::string& option, const std::string& value) {
  return option == "--set" ? option + " " + value.substr(0, value.find('=')) : option;
}

std::string text_of(const Json& value) { return value.is_string() ? value.get<std::string>() : value.dump(); }

std::vector<std::string> strings(const Json& object, const char* key, std::vector<std::string> otherwise) {
  if (!object.contains(key)) return otherwise;
  return object.at(key).get<std::vector<std::string>>();
}

std::vector<std::string> pairs_of(const Json& object, const char* key) {
  std::vector<std::string> words = words_of(object.value(key, std::string()));
  if (words.size() % 2 != 0) throw std::runtime_error(std::string(key) + ": options come as --name value");
  return words;
}

void add_technique(Sweep& sweep, const Json& table, const Json& entry) {
  const std::vector<std::string> all = strings(table, "lights", {"indirect", "full"});
  Setting own;
  own.technique = entry.at("name").get<std::string>();
  own.renderer = entry.value("command", std::string("render"));
  own.one_bounce = entry.value("one_bounce", false);
  own.baseline = entry.value("baseline", false);
  own.options = pairs_of(entry, "options");
  own.lights = strings(entry, "lights", all);
  own.times_at = entry.value("times_at", table.value("times_at", std::string()));
  if (entry.contains("frames")) own.frames = entry.at("frames").get<int>();
  if (entry.value("unvaried", true)) sweep.settings.push_back(own);
  const auto add = [&](const std::vector<std::string>& changes) {
    Setting varied = own;
    varied.lights = strings(entry, "varied_lights", strings(table, "varied_lights", own.lights));
    varied.options = with_options(own.options, changes);
    varied.varied = fmt::format("{}", fmt::join(changes, " "));
    sweep.settings.push_back(varied);
  };
  const Json vary = entry.value("vary", Json::object());
  for (const auto& [option, values] : vary.items())
    for (const Json& value : values) add({option, text_of(value)});
  for (const Json& together : entry.value("also", Json::array())) add(words_of(together.get<std::string>()));
}

void check(const Sweep& sweep) {
  std::set<std::string> seen;
  for (const Setting& setting : sweep.settings) {
    if (!seen.insert(setting.label()).second) throw std::runtime_error(setting.label() + ": listed twice");
    for (const std::string& light : setting.lights)
      if (light != "indirect" && light != "full")
        throw std::runtime_error(setting.label() + ": light '" + light + "' is neither indirect nor full");
  }
  if (sweep.settings.empty()) throw std::runtime_error("it lists no technique");
}

}  // namespace

std::vector<std::string> words_of(const std::string& text) {
  std::istringstream stream(text);
  return {std::istream_iterator<std::string>(stream), {}};
}

std::vector<std::string> with_options(std::vector<std::string> options, const std::vector<std::string>& changes) {
  for (size_t c = 0; c + 1 < changes.size(); c += 2) {
    size_t at = 0;
    while (at + 1 < options.size() && key_of(options[at], options[at + 1]) != key_of(changes[c], changes[c + 1]))
      at += 2;
    if (at + 1 >= options.size()) options.insert(options.end(), {changes[c], std::string()});
    options[at + 1] = changes[c + 1];
  }
  return options;
}

Sweep parse_sweep(std::string_view json, const std::string& name) {
  Sweep sweep;
  std::string technique;
  try {
    const Json table = Json::parse(json);
    sweep.scenes = strings(table, "scenes", {});
    sweep.size = table.value("size", sweep.size);
    sweep.frames = table.value("frames", sweep.frames);
    sweep.references = pairs_of(table, "references");
    for (const Json& entry : table.at("techniques")) {
      technique = entry.value("name", std::string("a technique without name")) + ": ";
      add_technique(sweep, table, entry);
    }
    technique.clear();
    check(sweep);
  } catch (const std::exception& error) {
    throw Error(ExitCode::bad_input, fmt::format("{}: {}", name, one_line(technique + error.what())));
  }
  return sweep;
}

}  // namespace volgi::app
